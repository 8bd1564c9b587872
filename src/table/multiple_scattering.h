#pragma once
#include <memory>
#include <span>

#include "core/spectrum.h"
#include "medium/homogeneous.h"
#include "table/scattered_light.h"

namespace turbid {

/// A stretch of a straight line: origin + t direction, 0 <= t <= length. The direction is a unit vector, the length may
/// be infinite.
struct Stretch {
  Vec3 origin, direction;
  float length;
};

/// One of several sources whose light adds up; of negative weight where it takes away.
struct WeightedStretch {
  Stretch stretch;
  float weight;
};

/// Light of the third and higher orders of scattering in a homogeneous medium that goes on for ever: the four queries
/// of S1 eq. 6-11, per colour channel, in scene units. Each channel has its own albedo and mean free path, so its own
/// ScatteredLight, looked up in its own units.
///
/// Light comes in two forms: a photon that collides at a point (it travelled along a direction), or one that sets out
/// unscattered along a stretch, where it may collide. All results are per unit of flux that collides or sets out, and
/// hold everything but that flux: the collisions' albedos, the last deflection, transmittance within the light's
/// stretch.
///
///   at a point     source radiance towards w, 1/sr per cubic scene unit: what scatters there towards w
///   along a stretch its integral along a ray of the sensor, times the transmittance to the ray's origin: radiance per
///                  flux, 1/sr per square scene unit
///
/// Channels in which nothing is extinguished or scattered are black. Immutable, shared between threads.
class MultipleScattering {
 public:
  /// From any table's lights.
  MultipleScattering(const HomogeneousMedium& medium, const ChannelLights& lights);
  /// From a table of mode `exact`. Throws std::invalid_argument (with advice) when an albedo is above kLargestAlbedo.
  /// from_order: 3, 4 or 5, counting all collisions, the light's first one and the last one included.
  MultipleScattering(const HomogeneousMedium& medium, const ScatteringTable& table, int from_order = 3)
      : MultipleScattering(medium, exact_lights(medium, table, from_order)) {}
  ~MultipleScattering();

  /// Point to point (S1 eq. 6): light collides at `at`, having travelled along `direction`.
  Spectrum source_radiance(const Vec3& at, const Vec3& direction, const Vec3& x, const Vec3& w) const;
  /// Segment to point (S1 eq. 10): light sets out along a stretch.
  Spectrum source_radiance(const Stretch& light, const Vec3& x, const Vec3& w) const;

  /// Of several stretches; nowhere negative.
  Spectrum source_radiance(std::span<const WeightedStretch> lights, const Vec3& x, const Vec3& w) const;

  /// Point to segment (S1 eq. 8): along `view`, which leads away from the sensor. By `2 samples` stratified points,
  /// half of them spread like the transmittance (of the channels' mean), half like the inverse square of the distance
  /// to the light; unbiased over u in [0,1), which shifts both.
  Spectrum radiance(const Vec3& at, const Vec3& direction, const Stretch& view, float u, int samples = 4) const;
  /// Segment to segment (S1 eq. 11): the points are spread about the place where the two come closest.
  Spectrum radiance(const Stretch& light, const Stretch& view, float u, int samples = 4) const {
    const WeightedStretch one[] = {{light, 1}};
    return radiance(one, view, u, samples);
  }
  /// The points are spread about the first of the lights.
  Spectrum radiance(std::span<const WeightedStretch> lights, const Stretch& view, float u, int samples = 4) const;

  /// The mean of the channels' extinction, 1/unit.
  float mean_sigma_t() const { return mean_sigma_t_; }

 private:
  struct Channel {
    std::shared_ptr<const ScatteredLight> light;  ///< null: the channel is black
    float sigma_t = 0, volume_scale = 0;          ///< sigma_t^3
  };
  /// Source radiance at eight places.
  using LaneSpectrum = std::array<Lanes, kChannels>;
  LaneSpectrum from_collision(const Vec3& at, const Vec3& direction, const Vec3Lanes& x, const Vec3& w) const;
  LaneSpectrum from_stretches(std::span<const WeightedStretch> lights, const Vec3Lanes& x, const Vec3& w) const;
  template <class Source>
  Spectrum integrate(const Stretch& view, float nearest, float distance, float u, int samples,
                     const Source& source) const;

  Channel channels_[kChannels];
  Spectrum sigma_t_;
  float mean_sigma_t_ = 0;
  float reach_ = 0;  ///< of the sensor's stretches: beyond it no channel transmits anything
};

}  // namespace turbid
