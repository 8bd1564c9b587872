#pragma once
#include "medium/majorant_grid.h"
#include "medium/medium.h"
#include "texture/volume.h"

namespace turbid {

/// What a heterogeneous medium is made of.
struct HeterogeneousParts {
  std::shared_ptr<const Volume> sigma_t = nullptr;   ///< extinction, 1/unit; its bounds are the medium's
  std::shared_ptr<const Volume> albedo = nullptr;    ///< sigma_s / sigma_t, in [0, 1]
  std::shared_ptr<const Volume> emission = nullptr;  ///< null: the medium does not shine
  float scale = 1;                                   ///< multiplies sigma_t
  float emission_scale = 1;                          ///< multiplies emission
  /// How emission is meant: false: radiance added per unit length, W/(sr m^2 unit); true: the radiance Le of matter
  /// that emits as much as it absorbs, so that sigma_a Le is added per unit length.
  bool emission_by_absorption = false;
  std::shared_ptr<const PhaseFunction> phase = nullptr;
};

/// Extinction, albedo and emission that vary in space, per channel; nothing outside of the extinction's bounds.
///
/// Flights are drawn by delta tracking over a grid of local majorants M(x), at least the extinction of every channel:
/// tentative collisions come with density M along the ray. With r_i = sigma_t,i/M and n_i = 1 - r_i, channel i would
/// take a tentative collision for real with probability r_i. A sequence of k - 1 null collisions and a real one carries
/// f_i = (prod n_i) sigma_s,i/M, and channel j alone would draw it with probability P_j = (prod n_j) r_j. Here it is
/// drawn from the mixture sum_j mix_j P_j: with N_j = mix_j prod n_j so far, the next collision is real with
/// probability sum_j N_j r_j / sum_j N_j. The weight, f_i over that mixture, is
///   collision: w_i = (prod n_i) albedo_i r_i / sum_j N_j r_j;   passed: w_i = prod n_i / sum_j N_j.
/// That is the balance heuristic over channels for the whole sequence (Miller et al. 2019, sect. 5.2, without their
/// choice of one hero): mix_i w_i <= albedo_i whatever the colours, and equal extinctions give w_i = albedo_i or 1.
class HeterogeneousMedium final : public Medium {
 public:
  /// Throws std::invalid_argument: a volume or the phase is missing, extinction or emission negative or infinite,
  /// albedo outside of [0, 1], bounds empty.
  explicit HeterogeneousMedium(const HeterogeneousParts& parts);

  /// Two numbers per tentative collision, one more at the end. Emission is gathered at every tentative collision, real
  /// or null, with the weight of arriving there over M: an unbiased estimate of its integral along the flight.
  Flight sample_flight(const Ray& ray, const Spectrum& mix, Sampler& sampler) const override;

  /// Residual ratio tracking (Novak et al. 2014): the cells' minorants attenuate exactly, what exceeds them is
  /// estimated with majorant M - min of the minorants.
  Spectrum transmittance(const Ray& ray, const Sampler& sampler) const override;

  /// From the cells' means; at least exp(-30), so that it never says that no light comes through.
  Spectrum proxy_transmittance(const Ray& ray) const override;
  Spectrum sigma_s_at(const Vec3& p) const override;
  /// The cell's mean, and not much less than its majorant.
  Spectrum proxy_sigma_t(const Vec3& p) const override;

  float max_sigma_t() const override { return max_sigma_t_; }
  /// Averages over the bounds.
  Spectrum sigma_t() const override { return mean_sigma_t_; }
  Spectrum sigma_s() const override { return mean_sigma_s_; }
  bool emits() const override { return parts_.emission != nullptr; }

  const Bounds3& bounds() const { return grid_.box(); }
  const MajorantGrid& majorants() const { return grid_; }

 private:
  void fill_grid();
  Spectrum extinction(const Vec3& p) const { return parts_.sigma_t->eval(p) * parts_.scale; }
  Spectrum emission(const Vec3& p, const Spectrum& extinction) const;

  HeterogeneousParts parts_;
  MajorantGrid grid_;
  float max_sigma_t_ = 0;
  Spectrum mean_sigma_t_, mean_sigma_s_;
};

}  // namespace turbid
