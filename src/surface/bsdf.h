#pragma once
#include <cstdint>
#include <memory>
#include <optional>

#include "core/spectrum.h"
#include "geometry/surface_point.h"

namespace turbid {

/// Which quantity travels along the sampled direction. Radiance is scaled by the squared ratio of indices at a
/// refractive boundary (L/eta^2 is the invariant), importance is not (Veach 1997, sect. 5.2). A walk that starts at the
/// sensor gathers radiance (kRadiance); a walk that starts at an emitter spreads it (kImportance).
enum class TransportMode : uint8_t { kRadiance, kImportance };

/// What happened at a surface; a set of bits.
namespace lobe {
using Flags = uint32_t;
inline constexpr Flags kNone = 0;
inline constexpr Flags kReflection = 1;    ///< stays on its side
inline constexpr Flags kTransmission = 2;  ///< changes sides
inline constexpr Flags kDelta = 4;         ///< one direction only: no density exists (never a pdf of 1)
inline constexpr Flags kNull = 8;     ///< goes straight on as if nothing were there; set with kDelta | kTransmission
inline constexpr Flags kSmooth = 16;  ///< has a density
}  // namespace lobe

/// A direction chosen by a BSDF. All directions are local (z = shading normal) and point away from the surface.
struct BsdfSample {
  Vec3 direction;   ///< the chosen one
  Spectrum weight;  ///< f |cos| / pdf_w, or for delta lobes the lobe's factor / its probability
  float pdf_w = 0;  ///< 1/sr, all smooth lobes that could have made this direction together; 0 when kDelta is set
  lobe::Flags flags = lobe::kNone;
  float eta = 1;  ///< index on the side of the chosen direction / index on the given side; 1 for reflection and null
};

/// The bidirectional scattering distribution of a surface point. Immutable, shared between threads.
///
/// `given` is the direction that the walk knows, `chosen` the one that it goes on along; for mode kRadiance given = wo
/// (towards the sensor) and chosen = wi, for kImportance given = wi and chosen = wo. f is not symmetric for refraction:
/// the mode says which factor applies. The correction for shading normals (Veach 1997, sect. 5.3) belongs to the walk,
/// not here.
class Bsdf {
 public:
  virtual ~Bsdf() = default;

  /// Union of the flags of all lobes. kNull here means that light may pass straight on.
  virtual lobe::Flags flags() const = 0;

  struct Eval {
    Spectrum value;   ///< f |cos(chosen)|, 1/sr, smooth lobes only
    float pdf_w = 0;  ///< density with which sample() chooses this direction, 1/sr, smooth lobes only
  };
  /// Value and density come from one function, so that they cannot disagree.
  virtual Eval eval(const SurfacePoint& point, const Vec3& given, const Vec3& chosen, TransportMode mode) const = 0;

  /// Chooses a direction. Takes three numbers: u_lobe to pick among lobes, u for the direction.
  virtual std::optional<BsdfSample> sample(const SurfacePoint& point, const Vec3& given, float u_lobe, const Vec2& u,
                                           TransportMode mode) const = 0;

  /// Factor of the light that passes straight on (null lobes): next-event estimation multiplies it along shadow rays.
  virtual Spectrum null_transmission(const SurfacePoint&, const Vec3& /*given*/) const { return Spectrum(0.0f); }

  /// pi f where that is the same for all directions on the side of `given` and 0 on the other: diffuse reflection.
  virtual std::optional<Spectrum> diffuse_reflectance(const SurfacePoint&, const Vec3& /*given*/) const {
    return std::nullopt;
  }

  /// Hemispherical reflectance (plus transmittance for scattering boundaries) of the smooth part, roughly; for layers
  /// and advice, not for light transport.
  virtual Spectrum albedo(const SurfacePoint&) const { return Spectrum(1.0f); }
};

}  // namespace turbid
