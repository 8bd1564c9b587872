#pragma once
#include "surface/bsdf.h"
#include "texture/texture_value.h"

namespace turbid {

/// Ideal diffuse (Lambertian) reflection: f = reflectance / pi on the outside, black on the inside.
class Diffuse final : public Bsdf {
 public:
  /// reflectance in [0, 1]; null: 0.5.
  explicit Diffuse(TexturePtr reflectance) : reflectance_(reflectance, 0.5f) {}

  lobe::Flags flags() const override { return lobe::kReflection | lobe::kSmooth; }
  Eval eval(const SurfacePoint& point, const Vec3& given, const Vec3& chosen, TransportMode mode) const override;
  std::optional<BsdfSample> sample(const SurfacePoint& point, const Vec3& given, float u_lobe, const Vec2& u,
                                   TransportMode mode) const override;
  std::optional<Spectrum> diffuse_reflectance(const SurfacePoint& point, const Vec3& given) const override {
    return given.z > 0 ? reflectance_.eval(point) : Spectrum(0.0f);
  }
  Spectrum albedo(const SurfacePoint& point) const override { return reflectance_.eval(point); }

 private:
  TextureValue reflectance_;
};

}  // namespace turbid
