#include "table/sampled_lobe.h"

#include <algorithm>
#include <cmath>

#include "core/gauss_legendre.h"

namespace turbid {
namespace {

constexpr int kSamples = SampledLobe::kSamples;
constexpr float kStep = kPi / kSamples;

/// A direction at an angle to the optimal axis and an azimuth about it, 0 in the sagittal plane towards positive
/// angles.
Vec3 about_axis(float axis, float theta, float phi) {
  const float along = std::cos(theta), in_plane = std::sin(theta) * std::cos(phi);
  return {along * std::sin(axis) + in_plane * std::cos(axis), std::sin(theta) * std::sin(phi),
          along * std::cos(axis) - in_plane * std::sin(axis)};
}

/// int 2 pi sin(theta) of the function that is 1 at a sample and linear to 0 at the next ones; the last one goes on.
const std::array<float, kSamples>& shares() {
  static const std::array<float, kSamples> result = [] {
    std::array<double, kSamples> sum{};
    const GaussLegendre rule(8);
    for (int i = 0; i < kSamples; ++i)
      for (size_t k = 0; k < rule.size(); ++k) {
        const double by = rule.node(k), step = static_cast<double>(kStep);
        const double mass = 2 * static_cast<double>(kPi) * std::sin((i + by) * step) * rule.weight(k) * step;
        sum[static_cast<size_t>(i)] += mass * (1 - by);
        sum[static_cast<size_t>(std::min(i + 1, kSamples - 1))] += mass * by;
      }
    std::array<float, kSamples> rounded{};
    std::copy(sum.begin(), sum.end(), rounded.begin());
    return rounded;
  }();
  return result;
}

/// The angle in the sagittal plane about which a cross-section is most nearly even.
float optimal_axis(const float* computed) {
  constexpr int kAngles = 144, kHalf = kAngles / 2;
  std::array<double, kAngles> section{};
  for (int c = 0; c < kChannels; ++c) {
    std::array<double, kAngles> values{};
    double sum = 0;
    for (int i = 0; i < kAngles; ++i) {
      const float angle = 2 * kPi * static_cast<float>(i) / kAngles;
      values[static_cast<size_t>(i)] = static_cast<double>(LobeDirections::interpolate(
          computed + static_cast<size_t>(c) * LobeDirections::kCount, {std::sin(angle), 0, std::cos(angle)}));
      sum += values[static_cast<size_t>(i)];
    }
    if (!(sum > 0)) continue;
    for (size_t i = 0; i < kAngles; ++i) section[i] += values[i] / sum;  // each channel counts alike
  }
  const auto at = [&](int i) { return section[static_cast<size_t>((i + 2 * kAngles) % kAngles)]; };
  int best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < kHalf; ++axis) {
    double difference = 0;
    for (int i = 1; i < kHalf; ++i) difference += sqr(at(axis + i) - at(axis - i));
    if (difference < least) {
      least = difference;
      best = axis;
    }
  }
  // Of the line's two ends that with more light about it.
  double ahead = 0;
  for (int i = -kHalf / 2; i < kHalf / 2; ++i) ahead += at(best + i) - at(best + kHalf + i);
  if (ahead < 0) best += kHalf;
  const float angle = 2 * kPi * static_cast<float>(best) / kAngles;
  return angle > kPi ? angle - 2 * kPi : angle;
}

}  // namespace

float SampledLobe::eval(int channel, const Vec3& d) const {
  const float sine = std::sin(axis()), cosine = std::cos(axis());
  const float t = std::acos(std::clamp(d.x * sine + d.z * cosine, -1.0f, 1.0f)) / kStep;
  const int i = std::min(static_cast<int>(t), kSamples - 1), next = std::min(i + 1, kSamples - 1);
  const float by = std::min(t - static_cast<float>(i), 1.0f);
  const float* values = curve(channel);
  if (!asymmetric_) return (1 - by) * values[i] + by * values[next];
  const float in_plane = d.x * cosine - d.z * sine, across = in_plane * in_plane + d.y * d.y;
  const float sagittal = across > 0 ? in_plane * in_plane / across : 1;  // cos^2 of the azimuth
  const float *other = numbers_ + kSymmetric, *coronal = other + kSamples;
  const auto at = [&](int k) {
    return values[k] * (sagittal * (in_plane < 0 ? other[k] : 1) + (1 - sagittal) * coronal[k]);
  };
  return (1 - by) * at(i) + by * at(next);
}

float SampledLobe::integral(int channel) const {
  float sum = 0;
  const float *other = numbers_ + kSymmetric, *coronal = other + kSamples;
  for (int i = 0; i < kSamples; ++i) {
    const float mean = asymmetric_ ? (1 + other[i]) / 4 + coronal[i] / 2 : 1;
    sum += shares()[static_cast<size_t>(i)] * curve(channel)[i] * mean;
  }
  return sum;
}

void SampledLobe::fit(const float* computed, bool asymmetric, float* numbers) {
  static const LobeDirections directions;
  constexpr int kAzimuths = 2 * LobeDirections::kAzimuths;
  std::fill_n(numbers, size(asymmetric), 0.0f);
  std::array<float, kChannels> whole{};
  for (size_t c = 0; c < kChannels; ++c)
    for (size_t k = 0; k < LobeDirections::kCount; ++k)
      whole[c] += computed[c * LobeDirections::kCount + k] * directions.solid_angle[k];
  if (!(*std::max_element(whole.begin(), whole.end()) > 0)) return;
  const float axis = numbers[0] = optimal_axis(computed);
  float *other = numbers + kSymmetric, *coronal = other + kSamples;
  int lit = 0;
  for (size_t c = 0; c < kChannels; ++c) {
    if (!(whole[c] > 0)) continue;
    ++lit;
    float* curve = numbers + 1 + c * kSamples;
    const auto value = [&](int i, float phi) {
      return LobeDirections::interpolate(computed + c * LobeDirections::kCount,
                                         about_axis(axis, static_cast<float>(i) * kStep, phi));
    };
    for (int i = 0; i < kSamples; ++i) {
      if (asymmetric) {
        // Ratios need something to relate to.
        curve[i] = std::max(value(i, 0), 1e-4f * whole[c] / (4 * kPi));
        other[i] += value(i, kPi) / curve[i];
        coronal[i] += value(i, kPi / 2) / curve[i];
        continue;
      }
      for (int j = 0; j < kAzimuths; ++j)
        curve[i] += value(i, 2 * kPi * (static_cast<float>(j) + 0.5f) / kAzimuths) / kAzimuths;
    }
  }
  if (asymmetric)
    for (int i = 0; i < 2 * kSamples; ++i) other[i] /= static_cast<float>(lit);
  for (int c = 0; c < kChannels; ++c) {
    const float fitted = SampledLobe(numbers, asymmetric).integral(c);
    for (int i = 0; i < kSamples && fitted > 0; ++i)
      numbers[1 + c * kSamples + i] *= whole[static_cast<size_t>(c)] / fitted;
  }
}

}  // namespace turbid
