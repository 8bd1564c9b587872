#include "manylight/light_tree.h"

#include <numeric>

namespace turbid {

LightTree::LightTree(const VirtualLights& lights, const LineSettings& lines)
    : clamp_distance_(lines.clamp_distance), leaf_of_(lights.size()) {
  std::vector<uint32_t> order(lights.size());
  std::iota(order.begin(), order.end(), 0u);
  nodes_.reserve(2 * lights.size());
  if (!order.empty()) build(lights.points(), order, 0);
}

/// A cone around the mean of the normals.
void LightTree::find_cone(const std::vector<Scatterer>& lights, std::span<const uint32_t> range, Node& node) {
  Vec3 sum(0);
  for (const uint32_t light : range) {
    if (!lights[light].is_diffuse()) return;
    sum += lights[light].normal();
  }
  if (!(length(sum) > 0)) return;
  node.axis = normalize(sum);
  float cosine = 1;
  for (const uint32_t light : range) cosine = std::min(cosine, dot(node.axis, lights[light].normal()));
  constexpr float kRounding = 1e-3f;  // of angles in single precision: nothing that shines is left out
  node.angle = std::acos(std::max(cosine, -1.0f)) + kRounding;
}

uint32_t LightTree::build(const std::vector<Scatterer>& lights, std::span<uint32_t> range, uint32_t parent) {
  const auto index = static_cast<uint32_t>(nodes_.size());
  nodes_.emplace_back();
  Node node;
  node.parent = parent;
  for (const uint32_t light : range) {
    node.box.extendBy(lights[light].position());
    node.strength += lights[light].strength();
  }
  find_cone(lights, range, node);
  if (range.size() == 1) {
    node.light = range[0];
    leaf_of_[node.light] = index;
  } else {
    const Vec3 extent = node.box.size();
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    const size_t half = range.size() / 2;
    std::nth_element(range.begin(), range.begin() + static_cast<std::ptrdiff_t>(half), range.end(),
                     [&](uint32_t a, uint32_t b) {
                       const float x = lights[a].position()[axis], y = lights[b].position()[axis];
                       return x != y ? x < y : a < b;
                     });
    build(lights, range.subspan(0, half), index);
    node.second = build(lights, range.subspan(half), index);
  }
  nodes_[index] = node;
  return index;
}

class LightTree::Descent final : public LightSampler::Chooser {
 public:
  Descent(const std::vector<Node>& nodes, const std::vector<uint32_t>& leaf_of, float clamp_distance)
      : nodes_(nodes), leaf_of_(leaf_of), clamp_distance2_(sqr(static_cast<double>(clamp_distance))) {}

  void move_to(const Scatterer& place) override { place_ = &place; }

  std::optional<LightChoice> sample(double u) const override {
    if (nodes_.empty() || importance(nodes_[0]) == 0) return std::nullopt;
    uint32_t at = 0;
    double prob = 1;
    while (nodes_[at].second != 0) {
      const double first = share_of_first(at);
      const bool takes_first = u < first;
      u = takes_first ? u / first : (u - first) / (1 - first);
      prob *= takes_first ? first : 1 - first;
      at = takes_first ? at + 1 : nodes_[at].second;
    }
    if (prob == 0) return std::nullopt;
    return LightChoice{nodes_[at].light, prob};
  }

  double prob(size_t light) const override {
    double prob = 1;
    for (uint32_t at = leaf_of_[light]; at != 0; at = nodes_[at].parent) {
      const uint32_t parent = nodes_[at].parent;
      const double first = share_of_first(parent);
      prob *= at == parent + 1 ? first : 1 - first;
    }
    return prob;
  }

 private:
  double share_of_first(uint32_t parent) const {
    const double first = importance(nodes_[parent + 1]), second = importance(nodes_[nodes_[parent].second]);
    return first + second > 0 ? first / (first + second) : 0.5;
  }

  /// Strength over squared distance to the middle, at least half the box's diagonal; 0 only where no light of the box
  /// can bring anything.
  double importance(const Node& node) const {
    const Vec3 half = node.box.size() * 0.5f, way = node.box.center() - place_->position();
    double cosine = 1;
    if (place_->is_diffuse()) {
      const Vec3& n = place_->normal();
      // The highest corner above the place's plane: below, the box is dark.
      const float highest = dot(way, n) + std::abs(n.x) * half.x + std::abs(n.y) * half.y + std::abs(n.z) * half.z;
      if (!(highest > 0)) return 0;
      cosine = std::min(
          1.0, static_cast<double>(highest) / std::sqrt(static_cast<double>(std::max(dot(way, way), dot(half, half)))));
    }
    const double distance2 =
        std::max({static_cast<double>(dot(way, way)), static_cast<double>(dot(half, half)), clamp_distance2_, 1e-30});
    return static_cast<double>(node.strength) * cosine * cosine_at(node, way, length(half)) / distance2;
  }

  /// At most so large is the cosine at any of the lights: their normals turn by the cone's angle, their directions to
  /// the place by what the box subtends there. 0 only where none of them shines this way.
  static double cosine_at(const Node& node, const Vec3& way, float radius) {
    if (node.angle >= kPi) return 1;
    const float distance = length(way);
    if (!(distance > radius)) return 1;
    const float between = std::acos(std::clamp(-dot(way, node.axis) / distance, -1.0f, 1.0f));
    const float angle = std::max(0.0f, between - node.angle - std::asin(radius / distance));
    return angle < kPi / 2 ? static_cast<double>(std::cos(angle)) : 0;
  }

  const std::vector<Node>& nodes_;
  const std::vector<uint32_t>& leaf_of_;
  double clamp_distance2_;
  const Scatterer* place_ = nullptr;
};

std::unique_ptr<LightSampler::Chooser> LightTree::make_chooser() const {
  return std::make_unique<Descent>(nodes_, leaf_of_, clamp_distance_);
}

}  // namespace turbid
