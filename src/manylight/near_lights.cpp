#include "manylight/near_lights.h"

namespace turbid {
namespace {

std::vector<KdTree<3>::Point> positions_of(const VirtualLights& lights) {
  std::vector<KdTree<3>::Point> positions;
  positions.reserve(lights.points().size());
  for (const Scatterer& light : lights.points())
    positions.push_back({light.position().x, light.position().y, light.position().z});
  return positions;
}

}  // namespace

NearLights::NearLights(const VirtualLights& lights, const LineSettings& lines)
    : lights_(lights), lines_(lines), tree_(positions_of(lights)) {}

NearLights::Choice::Choice(const NearLights& near, const Scatterer& place) {
  std::array<Tree::Neighbour, kCount> found;
  const Vec3& p = place.position();
  const size_t neighbours = near.tree_.nearest({p.x, p.y, p.z}, found);
  double sum = 0;
  for (size_t i = 0; i < neighbours; ++i) {
    const auto brings =
        static_cast<double>(unshadowed(place, near.lights_.points()[found[i].index], near.lines_).mean());
    if (!(brings > 0)) continue;
    lights_[count_] = found[i].index;
    probs_[count_++] = brings;
    sum += brings;
  }
  if (!std::isfinite(sum)) *this = {};
  for (size_t i = 0; i < count_; ++i) probs_[i] /= sum;
}

}  // namespace turbid
