#pragma once
#include <array>
#include <memory>
#include <vector>

#include "core/frame.h"
#include "surface/microfacet.h"

namespace turbid {

/// The part of the energy that single-scattering microfacets lose, over the cosine, on both sides of a boundary.
///
/// m_i(mu) = 1 - (what leaves in all directions, both sides, in importance mode), i = 0 outside, 1 inside. The light is
/// given back by one more lobe (the idea of Kulla & Conty 2017, for both sides of a refractive boundary), in importance
/// mode
///   f(i, mu -> j, mu') = m_i(mu) m_j(mu') n_j^2 / (pi S),   S = sum_i n_i^2 mean_i,   mean_i = 2 int m_i(mu) mu dmu.
/// It integrates to m_i(mu) over j and mu', so energy is kept up to the table's own error; and f / n_j^2 is symmetric,
/// so the usual factor between the modes makes it right in both, and reciprocal. A conductor is the case of one side: S
/// = mean_0.
class EnergyTable {
 public:
  static constexpr size_t kNodes = 64;

  /// eta = interior / exterior index; 0: only the outside, perfectly reflecting.
  EnergyTable(MicrofacetType type, float alpha, float eta);

  /// Tables are shared between all BSDFs that ask for the same; a table takes a few 10 ms to make.
  static std::shared_ptr<const EnergyTable> shared(MicrofacetType type, float alpha, float eta);

  /// m_side(|cosine|).
  float missing(int side, float cosine) const;
  /// A cosine with density 2 m_side(mu) mu / mean_side; one number. mean_side must not be 0.
  float sample_cosine(int side, float u) const;
  /// mean_side.
  float mean(int side) const { return mean_[static_cast<size_t>(side)]; }

 private:
  std::array<std::array<float, kNodes>, 2> missing_{};     ///< over the square root of the cosine
  std::array<std::array<float, kNodes>, 2> cumulative_{};  ///< part of the mean below each node
  std::array<float, 2> mean_{};
};

/// The compensating lobe of a BSDF: off, with one table (constant roughness), or interpolated between tables over the
/// roughness. Anisotropic roughness is compensated as its geometric mean, which is approximate.
class EnergyCompensation {
 public:
  EnergyCompensation() = default;  ///< off
  EnergyCompensation(const RoughnessValue& roughness, float eta);

  bool is_on() const { return !tables_.empty(); }

  /// The tables' values at a roughness and a given direction.
  struct Lobe {
    float missing = 0;             ///< m(given): also the probability of sampling this lobe
    std::array<float, 2> share{};  ///< part of it that goes to the outside, inside: n_j^2 mean_j / S
    std::array<float, 2> inverse_mean{};
    const EnergyTable *low = nullptr, *high = nullptr;
    float t = 0;  ///< weight of `high`

    /// m of any direction at this roughness.
    float missing_at(const Vec3& direction) const;
    /// f |cos| in importance mode, without colour.
    float value(const Vec3& chosen) const;
    /// Density of sample(), given that this lobe was picked: value() / missing.
    float pdf_w(const Vec3& chosen) const;
    /// Direction; u_lobe picks the side.
    Vec3 sample(float u_lobe, const Vec2& u) const;
  };
  Lobe at(float alpha, const Vec3& given) const;

 private:
  float eta_ = 0;
  std::vector<std::shared_ptr<const EnergyTable>> tables_;
};

}  // namespace turbid
