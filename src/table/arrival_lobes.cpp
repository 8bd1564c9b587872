#include "table/arrival_lobes.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"

namespace turbid {

uint32_t ArrivalLobes::step(const Vec3& d) {
  const float theta = std::acos(std::clamp(d.z, -1.0f, 1.0f)), phi = std::atan2(std::abs(d.y), d.x);
  const int i = std::min(static_cast<int>(theta * (kPolar / kPi)), kPolar - 1);
  const int j = std::min(static_cast<int>(phi * (kAzimuths / kPi)), kAzimuths - 1);
  return static_cast<uint32_t>(i * kAzimuths + j);
}

ArrivalLobes::ArrivalLobes(const PhaseFunction& phase) : values_(size_t{kPolar} * kAzimuths * LobeDirections::kCount) {
  // f by the sine of half the angle, in steps.
  constexpr size_t kSteps = 2048;
  std::array<float, kSteps> f;
  for (size_t i = 0; i < kSteps; ++i) f[i] = phase.eval_angle(2 * std::asin((static_cast<float>(i) + 0.5f) / kSteps));
  const LobeDirections directions;
  parallel_for(kPolar, [&](size_t i) {
    for (size_t j = 0; j < kAzimuths; ++j) {
      const float theta = kPi * (static_cast<float>(i) + 0.5f) / kPolar;
      const float phi = kPi * (static_cast<float>(j) + 0.5f) / kAzimuths;
      const Vec3 d(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
      float* const lobe = values_.data() + (i * kAzimuths + j) * LobeDirections::kCount;
      for (size_t k = 0; k < LobeDirections::kCount; ++k) {
        const float in_plane = directions.x[k] * d.x + directions.z[k] * d.z, off = directions.y[k] * d.y;
        const auto at = [&](float mu) {
          const float half_sine = std::sqrt(std::max(0.5f - 0.5f * mu, 0.0f));
          return f[static_cast<size_t>(std::min(half_sine * kSteps, kSteps - 1.0f))];
        };
        lobe[k] = (at(in_plane + off) + at(in_plane - off)) / 2;
      }
    }
  });
}

}  // namespace turbid
