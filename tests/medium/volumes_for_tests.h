#pragma once
#include "medium/heterogeneous.h"
#include "medium/isotropic.h"
#include "texture/constant_volume.h"
#include "texture/grid_volume.h"

namespace turbid::testing {

inline std::shared_ptr<const Volume> constant_volume(const Spectrum& value, const Transform& to_world = {}) {
  return std::make_shared<ConstantVolume>(value, to_world);
}

/// A grid of nx x 1 x 1 voxels with these values, over [0, length] x [-wide/2, wide/2]^2. Between the centres of two
/// voxels it is linear, beyond the first and last constant.
inline std::shared_ptr<const Volume> row_volume(const std::vector<Spectrum>& values, double length,
                                                GridFilter filter = GridFilter::kTrilinear, double wide = 1) {
  std::vector<float> numbers;
  for (const Spectrum& v : values)
    for (int c = 0; c < kChannels; ++c) numbers.push_back(v[c]);
  return std::make_shared<GridVolume>(
      GridVoxels::from_dense({static_cast<int>(values.size()), 1, 1}, 3, VoxelFormat::kFloat, numbers),
      GridSettings{.filter = filter,
                   .to_world = Transform::translate(0, -wide / 2, -wide / 2) * Transform::scale(length, wide, wide)});
}

inline HeterogeneousMedium make_medium(std::shared_ptr<const Volume> sigma_t, std::shared_ptr<const Volume> albedo,
                                       std::shared_ptr<const Volume> emission = nullptr,
                                       bool emission_by_absorption = false) {
  return HeterogeneousMedium({.sigma_t = std::move(sigma_t),
                              .albedo = std::move(albedo),
                              .emission = std::move(emission),
                              .emission_by_absorption = emission_by_absorption,
                              .phase = std::make_shared<IsotropicPhase>()});
}

/// Mean of a quantity per channel over many samples, and the standard error of the mean.
struct Mean {
  std::array<double, kChannels> sum{}, squares{};
  int count = 0;

  void add(const Spectrum& v) {
    for (size_t c = 0; c < kChannels; ++c) {
      const auto x = static_cast<double>(v[static_cast<int>(c)]);
      sum[c] += x;
      squares[c] += x * x;
    }
    ++count;
  }
  double mean(size_t c) const { return sum[c] / count; }
  double error(size_t c) const {
    const double m = mean(c);
    return std::sqrt(std::max(0.0, squares[c] / count - m * m) / count);
  }
  /// How many standard errors the mean is off.
  double z(size_t c, double expected) const {
    const double e = error(c);
    return std::abs(mean(c) - expected) / std::max(e, 1e-6);
  }
};

/// A deviation that right estimators exceed once in 10^5 tests.
inline constexpr double kWorstZ = 4.4;

}  // namespace turbid::testing
