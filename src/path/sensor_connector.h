#pragma once
#include <optional>

#include "image/splat_buffer.h"
#include "path/light_sources.h"
#include "path/traveller.h"

namespace turbid {

/// How light that sets out towards the sensor arrives there.
struct SensorArrival {
  SplatTarget target;  ///< a pixel of the crop window
  Spectrum weight;     ///< of flux per solid angle (W/sr) in the pixel's value, in a picture made from `paths` paths
  /// Density with which sensor rays through the film choose the line, in units of one ray per pixel for each light
  /// path: per area across it at the far end, or 1/sr for light from infinity.
  float pdf = 0;
  Spectrum proxy;  ///< Passage::proxy of the line
  Vec3 position;   ///< on the aperture
};

/// Joins points of light paths with the sensor, and finds the pixels that see them.
class SensorConnector {
 public:
  /// `paths`: how many light paths make one picture. Random numbers come from Sampler::aside.
  SensorConnector(const Scene& scene, double paths, const Sampler& sampler, SampleCounters& counters);

  /// The way from a point to the aperture. Empty where the sensor does not look.
  std::optional<SensorConnection> way_from(const Vec3& p) const {
    return scene_.sensor().connect(p, aperture_numbers(p));
  }
  /// Those with which way_from chooses the point of the aperture.
  Vec2 aperture_numbers(const Vec3& p) const {
    Rng rng = sampler_.aside(Purpose::kAperture, p);
    return next_2d(rng);
  }
  /// The directions from a point of the aperture in which pixels look. Only for sensors with an aperture.
  Cone view_from(const Vec2& u_aperture) const {
    return scene_.sensor().needs_aperture() ? find_view(u_aperture) : view_;
  }

  /// Follows a way_from a point. `traveller` stands there; `surface` if it is one, `origin` lies off it. `flux`: what
  /// sets out, any scale; black flux never arrives.
  std::optional<SensorArrival> arrive(const SensorConnection& way, const Vec3& origin, const Spectrum& flux,
                                      const Traveller& traveller, const SurfaceEvent* surface = nullptr) const;

  /// The same from a point in a medium (null: vacuum), whoever stands there. Not for scenes with priorities.
  std::optional<SensorArrival> arrive(const SensorConnection& way, const Vec3& origin, const Spectrum& flux,
                                      const Medium* medium) const;

  /// A light seen directly: a surface that shines, or the sky. The weight is that of the emission's throughput. Empty
  /// for lights that are no sight.
  std::optional<SensorArrival> arrive_from(const Emission& emission, const Traveller& traveller) const;

  const Vec2i& size() const { return crop_; }
  size_t index_of(const Vec2i& pixel) const {
    return static_cast<size_t>(pixel.y) * static_cast<size_t>(crop_.x) + static_cast<size_t>(pixel.x);
  }

  /// Density of sensor rays (SensorArrival::pdf) from the importance of a connection.
  float pdf(const SensorConnection& way) const { return way.importance * scale_; }

 private:
  Cone find_view(const Vec2& u_aperture) const;
  template <class Look>
  std::optional<SensorArrival> arrive_by(const SensorConnection& way, const Vec3& origin, const Spectrum& flux,
                                         const Look& look) const;
  std::optional<SensorArrival> arrive_from_sky(const Emission& emission) const;
  static Vec2 next_2d(Rng& rng) {
    const float u = rng.next_float();
    return {u, rng.next_float()};
  }
  std::optional<SplatTarget> target_of(const SensorConnection& way) const;
  SensorArrival arrival(const SplatTarget& target, const SensorConnection& way, const Spectrum& factor,
                        const Spectrum& proxy) const;
  /// Attenuation between the sensor and its near plane.
  Spectrum near_part(const SensorConnection& way, const Vec3& direction) const;

  const Scene& scene_;
  const FilmSettings& film_;
  Vec2i crop_;
  Cone view_;    ///< of sensors without needs_aperture()
  float scale_;  ///< pixels of the whole film per light path
  const Sampler& sampler_;
  SampleCounters& counters_;
};

}  // namespace turbid
