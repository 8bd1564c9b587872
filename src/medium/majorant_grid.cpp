#include "medium/majorant_grid.h"

#include <stdexcept>

namespace turbid {

MajorantGrid::MajorantGrid(const Bounds3& box, const std::array<int, 3>& cells) : box_(box), counts_(cells) {
  size_t count = 1;
  for (unsigned a = 0; a < 3; ++a) {
    if (counts_[a] < 1 || !(box.max[a] > box.min[a])) throw std::invalid_argument("a majorant grid needs a volume");
    cell_size_[a] = (box.max[a] - box.min[a]) / static_cast<float>(counts_[a]);
    count *= static_cast<size_t>(counts_[a]);
  }
  cells_.resize(count);
}

Bounds3 MajorantGrid::cell_box(int x, int y, int z) const {
  constexpr float kPadding = 1e-3f;  // of a cell
  const Vec3 low(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
  return {box_.min + (low - Vec3(kPadding)) * cell_size_, box_.min + (low + Vec3(1 + kPadding)) * cell_size_};
}

std::optional<std::array<float, 2>> MajorantGrid::clip(const Ray& ray) const {
  float near = 0, far = ray.t_max;
  for (unsigned a = 0; a < 3; ++a) {
    const float o = ray.origin[a], d = ray.direction[a];
    if (d == 0) {
      if (o < box_.min[a] || o > box_.max[a]) return std::nullopt;
      continue;
    }
    const float t0 = (box_.min[a] - o) / d, t1 = (box_.max[a] - o) / d;
    near = std::max(near, std::min(t0, t1));
    far = std::min(far, std::max(t0, t1));
  }
  if (!(near < far)) return std::nullopt;
  return std::array<float, 2>{near, far};
}

}  // namespace turbid
