#pragma once
#include <limits>

#include "medium/medium.h"

namespace turbid {

/// The same coefficients everywhere.
///
/// The class is final and its functions are inline: a caller that holds a HomogeneousMedium& pays no virtual call.
class HomogeneousMedium final : public Medium {
 public:
  /// Coefficients in 1/unit. Throws std::invalid_argument unless all are finite and 0 <= sigma_s <= sigma_t.
  HomogeneousMedium(const Spectrum& sigma_t, const Spectrum& sigma_s, std::shared_ptr<const PhaseFunction> phase);

  /// One number.
  Flight sample_flight(const Ray& ray, const Spectrum& mix, Sampler& sampler) const override {
    return flight(ray.t_max, mix, sampler.next_1d());
  }

  /// The flight that the number u in [0,1) stands for. u picks the channel by `mix` and is rescaled to draw the
  /// distance, which keeps the stratification of a low-discrepancy u; distances reach 16 mean free paths (u has 24
  /// bits). With T_i = exp(-sigma_t,i t) for each channel i:
  ///   collision: weight_i = sigma_s,i T_i / sum_j mix_j sigma_t,j T_j
  ///   passed:    weight_i = T_i / probability, probability = sum_j mix_j T_j
  /// A channel with sigma_t = 0 always passes. Where all channels have the same sigma_t the exponentials cancel. A
  /// medium that only absorbs is always passed, with weight T_i and probability 1: coloured glass is free of noise.
  Flight flight(float t_max, const Spectrum& mix, float u) const {
    if (!scatters_) return passage(t_max, mix);
    return grey_ ? grey_flight(t_max, u) : chromatic_flight(t_max, mix, u);
  }

  /// The flight that passes a distance t without a collision, for callers that learn t after they drew a longer one.
  Flight passage(float t, const Spectrum& mix) const {
    const Spectrum passed = transmittance(t);
    if (!scatters_) return {false, 0, passed, 1};
    if (grey_) return {false, 0, Spectrum(1.0f), passed[0]};
    const float probability = (mix * passed).sum();
    return {false, 0, passed / probability, probability};
  }

  /// exp(-sigma_t t) per channel; t may be infinite. 1 where sigma_t = 0.
  Spectrum transmittance(float t) const {
    t = std::min(t, std::numeric_limits<float>::max());  // so that 0 * infinity does not arise
    if (grey_) return Spectrum(std::exp(-sigma_t_[0] * t));
    Spectrum result;
    for (int c = 0; c < kChannels; ++c) result[c] = std::exp(-sigma_t_[c] * t);
    return result;
  }
  Spectrum transmittance(const Ray& ray, const Sampler&) const override { return transmittance(ray.t_max); }
  Spectrum proxy_transmittance(const Ray& ray) const override { return transmittance(ray.t_max); }

  Spectrum proxy_sigma_t(const Vec3&) const override { return sigma_t_; }

  float max_sigma_t() const override { return sigma_t_.max(); }
  const HomogeneousMedium* as_homogeneous() const override { return this; }
  Spectrum sigma_t() const override { return sigma_t_; }
  Spectrum sigma_s() const override { return sigma_s_; }
  /// sigma_s / sigma_t, 0 where sigma_t = 0.
  const Spectrum& albedo() const { return albedo_; }
  /// All channels have the same sigma_t.
  bool is_grey() const { return grey_; }

 private:
  Flight grey_flight(float t_max, float u) const {
    const float t = -std::log(1 - u) * mean_free_path_[0];  // 1 - u is exact: u has 24 bits
    // NaN (u = 0 and no extinction) passes as well.
    if (t < t_max) return {true, t, albedo_, 1};
    return passage(t_max, Spectrum(1.0f));
  }

  Flight chromatic_flight(float t_max, const Spectrum& mix, float u) const {
    int picked = 0;
    while (picked + 1 < kChannels && u >= mix[picked]) u -= mix[picked++];
    while (mix[picked] <= 0 && picked > 0) u = kOneMinusEpsilon * mix[--picked];  // mix summed to a little less than 1
    const float survival = 1 - std::min(u / mix[picked], kOneMinusEpsilon);       // the picked channel's transmittance
    const float t = -std::log(survival) * mean_free_path_[picked];
    if (!(t < t_max)) return passage(t_max, mix);
    // Knowing one transmittance saves an exponential and keeps the density above zero.
    Spectrum arrived;
    for (int c = 0; c < kChannels; ++c) arrived[c] = c == picked ? survival : std::exp(-sigma_t_[c] * t);
    const float pdf_t = (mix * sigma_t_ * arrived).sum();
    return {true, t, sigma_s_ * arrived / pdf_t, 1};
  }

  Spectrum sigma_t_, sigma_s_, albedo_;
  Spectrum mean_free_path_;  ///< 1 / sigma_t, infinite where sigma_t = 0
  bool grey_, scatters_;
};

}  // namespace turbid
