#include "table/far_field.h"

#include <algorithm>
#include <cmath>

namespace turbid {

FarField::FarField(std::span<const double> moments, double albedo, SourceKind kind)
    : decay_(decay_rate(moments, albedo)),
      centre_(static_cast<float>(moments[1] / (1 - albedo * moments[1]) + (kind == SourceKind::kRay ? 1 : 0))) {}

int FarField::edge(const PolarGrid& grid) const {
  const double edge = std::max({20.0, 4 / decay_, std::min(6 / decay_, 60.0)});
  // The outermost node is left out: beyond it the grid supposes that nothing falls off, which makes it too low.
  return std::min(static_cast<int>(std::lround(grid.radial(static_cast<float>(edge)) - 0.5f)), grid.radii() - 2);
}

float FarField::ratio(float to, float from, float cosine) const {
  const auto from_centre = [&](float r) {
    return std::sqrt(std::max(1e-6f, r * r - 2 * r * centre_ * cosine + centre_ * centre_));
  };
  const float far = from_centre(to), near = from_centre(from);
  return std::exp(static_cast<float>(decay_) * (near - far)) * near / far * (to / from);
}

}  // namespace turbid
