#pragma once
#include <optional>

#include "core/cone.h"
#include "core/ray.h"
#include "core/spectrum.h"
#include "geometry/shape.h"

namespace turbid {

/// A direction towards a light, chosen by an emitter for next-event estimation.
struct DirectLightSample {
  Vec3 wi;             ///< unit, from the receiving point towards the light
  float distance = 0;  ///< to the point on the light; infinite for lights at infinity
  Vec3 position{0};    ///< the point on the light (undefined for lights at infinity)
  Spectrum weight{0};  ///< Le / pdf_w for lights with area, or intensity / distance^2 (irradiance) for delta lights
  float pdf_w = 0;     ///< 1/sr at the receiving point; 0 when delta is true
  bool delta = false;  ///< point, spot, directional: no other technique can find it
  Vec3 ng{0};          ///< geometric normal at the point, for lights with a surface; else zero
};

/// With which densities sample_emission chooses a ray.
struct EmissionPdf {
  float pdf_a = 0;  ///< of the origin, per unit area (lights at infinity: of a plane across the direction); 0: a point
  float pdf_w = 0;  ///< of the direction given the origin, 1/sr; 0: a single direction, or one that is never chosen
};

/// A ray that leaves a light, chosen in proportion to what it carries as nearly as the light knows how.
struct EmissionSample {
  Vec3 origin;      ///< off the light's own surface, on the side that the ray leaves to
  Vec3 direction;   ///< unit, away from the light
  Spectrum weight;  ///< flux: Le |cos| / (pdf_a pdf_w) with the factors that exist, W
  EmissionPdf pdf;
  Vec3 ng{0};  ///< geometric normal at the origin, for lights with a surface; else zero
};

/// A source of light. Immutable after `set_scene_bounds`, shared between threads.
class Emitter {
 public:
  virtual ~Emitter() = default;

  /// Lights at infinity learn the bounding sphere of the scene before rendering.
  virtual void set_scene_bounds(const Vec3& /*center*/, float /*radius*/) {}

  /// Chooses a direction to this light from `from`; takes two numbers.
  virtual std::optional<DirectLightSample> sample_direct(const Vec3& from, const Vec2& u) const = 0;

  /// The point or direction that sample_direct chose from some place, as `from` sees it: with the density that
  /// sample_direct(from) has there. Empty where it turns its back. The default holds for delta lights, which leave
  /// nothing to choose.
  virtual std::optional<DirectLightSample> seen_from(const Vec3& from, const DirectLightSample& /*chosen*/) const {
    return sample_direct(from, Vec2(0.5f));
  }

  /// Chooses a ray that leaves this light; takes four numbers. May be empty (a black place of a picture). Lights at
  /// infinity start their rays on the bounding sphere that set_scene_bounds gave, uniform in the disk across.
  virtual std::optional<EmissionSample> sample_emission(const Vec2& u_position, const Vec2& u_direction) const = 0;

  /// Densities with which sample_emission chooses a ray that leaves the light in `direction` (unit) from a point that
  /// belongs to the light, with geometric normal ng there (lights without a surface ignore it).
  virtual EmissionPdf emission_pdf(const Vec3& ng, const Vec3& direction) const = 0;

  /// What leaves the origin of a drawn ray in another direction (unit): Le |cos| / pdf_a or intensity, W/sr. Empty for
  /// lights whose origin does not leave the direction open: at infinity, beams.
  virtual std::optional<Spectrum> emission_towards(const EmissionSample& /*ray*/, const Vec3& /*direction*/) const {
    return std::nullopt;
  }

  /// Can a ray meet it by chance? False for delta lights.
  virtual bool can_be_hit() const = 0;
  /// False where sample_direct never finds a direction: beams.
  virtual bool can_be_aimed_at() const { return true; }
  /// Lights that stand in one place: the directions in which they shine.
  virtual Cone cone() const { return {}; }
  /// A box around every point that light starts from; infinite (the default) for lights at infinity.
  virtual Bounds3 bounds() const { return Bounds3(Vec3(-kInfinity), Vec3(kInfinity)); }

  /// At infinity: seen by rays that leave the scene.
  virtual bool is_environment() const { return false; }
  /// Environment and directional lights: no straight line from inside a closed boundary meets them.
  virtual bool is_at_infinity() const { return is_environment(); }

  /// Power estimate in W (per channel), used to choose among lights; environment lights: through the scene's disk.
  virtual Spectrum power() const = 0;
};

/// The start of a ray that comes from infinity along `direction`: uniform in the disk of the bounding sphere across it,
/// moved back to the sphere. The density is 1 / (pi radius^2) per unit area across.
Vec3 start_from_infinity(const Vec3& center, float radius, const Vec3& direction, const Vec2& u);

/// Light at infinity: constant, environment map.
class EnvironmentEmitter : public Emitter {
 public:
  /// Radiance that arrives from `direction` (unit, pointing away from the scene).
  virtual Spectrum Le(const Vec3& direction) const = 0;
  /// Density of sample_direct, 1/sr.
  virtual float pdf_direct_w(const Vec3& direction) const = 0;
  std::optional<DirectLightSample> seen_from(const Vec3&, const DirectLightSample& chosen) const final {
    return chosen;
  }
  bool can_be_hit() const final { return true; }
  bool is_environment() const final { return true; }

  void set_scene_bounds(const Vec3& center, float radius) final {
    center_ = center;
    radius_ = radius;
  }
  /// The direction as sample_direct chooses it, the start in the disk across.
  std::optional<EmissionSample> sample_emission(const Vec2& u_position, const Vec2& u_direction) const final;
  EmissionPdf emission_pdf(const Vec3&, const Vec3& direction) const final {
    return {1 / disk_area(), pdf_direct_w(-direction)};
  }

 protected:
  /// Area of the disk of the scene's bounding sphere.
  float disk_area() const { return kPi * sqr(radius_); }

 private:
  Vec3 center_;
  float radius_ = 1;
};

/// A surface that shines: one-sided, on the outside of its shape.
class SurfaceEmitter : public Emitter {
 public:
  /// Radiance leaving `point` in direction `w` (unit, away from the surface), W/(sr m^2); 0 on the inside.
  virtual Spectrum Le(const SurfacePoint& point, const Vec3& w) const = 0;
  /// Density with which sample_direct(from) chooses the point p of the light, with geometric normal ng there; 1/sr at
  /// `from`.
  virtual float pdf_direct_w(const Vec3& from, const Vec3& p, const Vec3& ng) const = 0;
  bool can_be_hit() const final { return true; }
};

}  // namespace turbid
