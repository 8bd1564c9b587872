#pragma once
#include <cstdint>

#include "core/vector.h"
#include "texture/texture_value.h"

namespace turbid {

enum class MicrofacetType : uint8_t { kBeckmann, kGgx };

/// The distribution of the normals of a rough surface's facets, and Smith's masking (Walter et al. 2007). Local frame,
/// z = the surface's mean normal. Isotropic when both roughnesses agree; alpha_u along x, alpha_v along y.
///
/// Shadowing and masking are separable, G(i, o) = g1(i) g1(o), as in Walter 2007 and in Mitsuba 3 (no height
/// correlation). For Beckmann g1 is the exact expression with erf, where Mitsuba 3 has a rational fit (up to 0.35 %
/// off).
class MicrofacetDistribution {
 public:
  /// Roughnesses below kMinAlpha are raised to it: float half vectors resolve no finer peak.
  static constexpr float kMinAlpha = 1e-4f;

  MicrofacetDistribution(MicrofacetType type, float alpha_u, float alpha_v);

  /// Density of facet normals m per solid angle and per area of the mean surface: the integral of d(m) cos(m) is 1.
  /// Zero for m.z <= 0.
  float d(const Vec3& m) const;
  /// Fraction of the facets with normal m that is seen from v (Smith); 0 when v and m disagree about the side of v.
  float g1(const Vec3& v, const Vec3& m) const;

  /// A facet normal with probability proportional to its area as seen from v (v.z > 0): Heitz 2018 for GGX, for
  /// Beckmann inversion of the slopes' distribution (Heitz & d'Eon 2014; Jakob 2014). Two numbers.
  Vec3 sample_visible(const Vec3& v, const Vec2& u) const;
  /// Its density in solid angle of m: g1(v) |v.m| d(m) / v.z.
  float pdf_visible(const Vec3& v, const Vec3& m) const;

  /// A facet normal with density d(m) cos(m), whoever looks. Two numbers.
  Vec3 sample_all(const Vec2& u) const;
  float pdf_all(const Vec3& m) const { return d(m) * std::max(0.0f, m.z); }

  /// The same distribution with both roughnesses times s.
  MicrofacetDistribution scaled(float s) const { return {type_, alpha_u_ * s, alpha_v_ * s}; }

 private:
  MicrofacetType type_;
  float alpha_u_, alpha_v_;
};

/// The roughness parameters of a BSDF. alpha_v null: isotropic.
struct Roughness {
  MicrofacetType type = MicrofacetType::kBeckmann;
  TexturePtr alpha_u, alpha_v;  ///< null: 0.1
  bool sample_visible = true;   ///< false: all normals are sampled (noisier; for comparison)
};

/// Roughness as kernels use it: makes the distribution at a point and samples it in the way that was asked for.
class RoughnessValue {
 public:
  explicit RoughnessValue(const Roughness& r)
      : type_(r.type),
        sample_visible_(r.sample_visible),
        alpha_u_(r.alpha_u, kDefaultAlpha),
        alpha_v_(r.alpha_v ? r.alpha_v : r.alpha_u, kDefaultAlpha) {}

  MicrofacetDistribution at(const SurfacePoint& p) const {
    return {type_, alpha_u_.eval_scalar(p), alpha_v_.eval_scalar(p)};
  }
  MicrofacetType type() const { return type_; }
  bool is_constant() const { return alpha_u_.is_constant() && alpha_v_.is_constant(); }
  /// Geometric mean of both roughnesses: that of an isotropic stand-in.
  float mean_alpha(const SurfacePoint& p) const {
    return std::sqrt(std::max(0.0f, alpha_u_.eval_scalar(p) * alpha_v_.eval_scalar(p)));
  }

  /// v.z > 0. Without visible normals the sampled distribution is a little wider, which bounds the weights (Walter et
  /// al. 2007, sect. 5.3).
  Vec3 sample(const MicrofacetDistribution& distribution, const Vec3& v, const Vec2& u) const {
    return sample_visible_ ? distribution.sample_visible(v, u) : widened(distribution, v).sample_all(u);
  }
  float pdf(const MicrofacetDistribution& distribution, const Vec3& v, const Vec3& m) const {
    return sample_visible_ ? distribution.pdf_visible(v, m) : widened(distribution, v).pdf_all(m);
  }

 private:
  static constexpr float kDefaultAlpha = 0.1f;
  static MicrofacetDistribution widened(const MicrofacetDistribution& d, const Vec3& v) {
    return d.scaled(1.2f - 0.2f * std::sqrt(std::abs(v.z)));
  }

  MicrofacetType type_;
  bool sample_visible_;
  TextureValue alpha_u_, alpha_v_;
};

}  // namespace turbid
