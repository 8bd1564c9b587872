#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "geometry/generated.h"
#include "geometry/row_mesh.h"

namespace turbid {
namespace {

/// Negative inside a body of limbs that melt into each other, about the distance to its surface.
class Body {
 public:
  Body(std::span<const Limb> limbs, float blend, const Relief& relief) : limbs_(limbs), blend_(blend), relief_(relief) {
    slope_ = 1;
    for (const Limb& limb : limbs)
      if (const float taper = std::abs(limb.from_radius - limb.to_radius); taper > 0)
        slope_ = std::max(slope_, std::hypot(1.0f, taper / length(limb.to - limb.from)));
    constexpr float kSlopeOfNoise = 4;  // 2.57 was the most at 6 million random points
    slope_ += kSlopeOfNoise * std::abs(relief.amplitude) * std::abs(relief.frequency);
  }

  float operator()(const Vec3& p) const {
    // The soft minimum -b ln(sum exp(-d / b)), relative to the least distance lest exp overflows.
    distances_.clear();
    float least = kInfinity;
    for (const Limb& limb : limbs_) {
      const Vec3 along = limb.to - limb.from;
      const float norm2 = length_squared(along);
      const float t = norm2 > 0 ? std::clamp(dot(p - limb.from, along) / norm2, 0.0f, 1.0f) : 0;
      const float radius = limb.from_radius + t * (limb.to_radius - limb.from_radius);
      distances_.push_back(length(p - (limb.from + along * t)) - radius);
      least = std::min(least, distances_.back());
    }
    float sum = 0;
    for (const float d : distances_) sum += std::exp((least - d) / blend_);
    const float relief =
        relief_.amplitude != 0 ? relief_.amplitude * smooth_noise(p * relief_.frequency, relief_.seed) : 0;
    return least - blend_ * std::log(sum) - relief;
  }

  Vec3 normal(const Vec3& p, float step) const {
    const Body& f = *this;
    const Vec3 x(step, 0, 0), y(0, step, 0), z(0, 0, step);
    return normalize(Vec3(f(p + x) - f(p - x), f(p + y) - f(p - y), f(p + z) - f(p - z)));
  }

  /// Of the field: it changes by no more than this per length.
  float slope() const { return slope_; }

  Bounds3 bounds() const {
    Bounds3 box;
    const float more = blend_ * std::log(static_cast<float>(limbs_.size())) + std::abs(relief_.amplitude);
    for (const Limb& limb : limbs_)
      for (const auto& [centre, radius] :
           {std::pair(limb.from, limb.from_radius), std::pair(limb.to, limb.to_radius)}) {
        box.extendBy(centre - Vec3(radius + more));
        box.extendBy(centre + Vec3(radius + more));
      }
    return box;
  }

 private:
  std::span<const Limb> limbs_;
  float blend_;
  Relief relief_;
  float slope_;
  mutable std::vector<float> distances_;
};

/// Marching tetrahedra (Doi and Koide 1991): six around the diagonal of each cell of a lattice, the same six in all, so
/// that neighbours fit. Each edge of the lattice that crosses the surface has one vertex; the mesh closes whatever the
/// field is.
class Polygoniser {
 public:
  Polygoniser(const Body& body, float cell) : body_(body), cell_(cell) {
    const Bounds3 box = body.bounds();
    origin_ = box.min - Vec3(cell);
    for (int axis = 0; axis < 3; ++axis)
      size_[static_cast<size_t>(axis)] = static_cast<int>(std::ceil((box.max[axis] - box.min[axis]) / cell)) + 3;
    mesh_.name = "limbs";
  }

  MeshData run() {
    for (int z = 0; z < size_[2]; ++z) {
      below_ = std::exchange(above_, layer(z));
      if (z == 0) continue;
      for (int y = 0; y + 1 < size_[1]; ++y)
        for (int x = 0; x + 1 < size_[0]; ++x) march({x, y, z - 1});
    }
    return std::move(mesh_);
  }

 private:
  using Node = std::array<int, 3>;

  Vec3 place(const Node& n) const {
    return origin_ + Vec3(static_cast<float>(n[0]), static_cast<float>(n[1]), static_cast<float>(n[2])) * cell_;
  }

  /// The field at the nodes of one z. Far from the surface it is not asked again before the surface can be near; where
  /// an edge crosses the surface both its ends are asked.
  std::vector<float> layer(int z) const {
    std::vector<float> values;
    values.reserve(static_cast<size_t>(size_[0]) * static_cast<size_t>(size_[1]));
    for (int y = 0; y < size_[1]; ++y)
      for (int x = 0; x < size_[0];) {
        const float value = body_(place({x, y, z}));
        constexpr int kNear = 2;  // more than the diagonal of a cell
        const int free = static_cast<int>(std::abs(value) / (body_.slope() * cell_));
        const int same = std::clamp(free - kNear, 1, size_[0] - x);
        values.insert(values.end(), static_cast<size_t>(same), value);
        x += same;
      }
    return values;
  }

  float value(const Node& n, int lower_z) const {
    const size_t i = static_cast<size_t>(n[1]) * static_cast<size_t>(size_[0]) + static_cast<size_t>(n[0]);
    return n[2] == lower_z ? below_[i] : above_[i];
  }

  void march(const Node& cell) {
    constexpr std::array<std::array<int, 3>, 6> kOrders{
        {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
    const auto corner = [&](int c) { return Node{cell[0] + (c & 1), cell[1] + (c >> 1 & 1), cell[2] + (c >> 2)}; };
    int inside = 0;
    for (int c = 0; c < 8; ++c) inside += value(corner(c), cell[2]) < 0;
    if (inside == 0 || inside == 8) return;
    for (size_t i = 0; i < kOrders.size(); ++i) {
      // From one end of the diagonal to the other along the axes in one order; the first three orders are even.
      const auto& axes = kOrders[i];
      tetrahedron({corner(0), corner(1 << axes[0]), corner(1 << axes[0] | 1 << axes[1]), corner(7)}, i < 3, cell[2]);
    }
  }

  void tetrahedron(const std::array<Node, 4>& corners, bool even, int lower_z) {
    std::array<size_t, 4> order{};  // those inside first
    size_t count = 0;
    for (const bool wanted : {true, false})
      for (size_t i = 0; i < 4; ++i)
        if ((value(corners[i], lower_z) < 0) == wanted) order[count++] = i;
    const auto inside =
        std::count_if(corners.begin(), corners.end(), [&](const Node& n) { return value(n, lower_z) < 0; });
    if (inside == 0 || inside == 4) return;
    for (size_t i = 0; i < 4; ++i)
      for (size_t j = 0; j < i; ++j) even ^= order[j] > order[i];
    const auto vertex = [&](size_t a, size_t b) { return vertex_on(corners[order[a]], corners[order[b]], lower_z); };
    const auto triangle = [&](uint32_t a, uint32_t b, uint32_t c) {
      if (!even) std::swap(b, c);
      mesh_.indices.insert(mesh_.indices.end(), {a, b, c});
    };
    if (inside == 1) {
      triangle(vertex(0, 1), vertex(0, 2), vertex(0, 3));
    } else if (inside == 3) {
      triangle(vertex(0, 3), vertex(1, 3), vertex(2, 3));
    } else {
      const uint32_t a = vertex(0, 2), b = vertex(0, 3), c = vertex(1, 3), d = vertex(1, 2);
      triangle(a, b, c);
      triangle(a, c, d);
    }
  }

  uint32_t vertex_on(const Node& inside, const Node& outside, int lower_z) {
    const auto number = [&](const Node& n) {
      return (static_cast<uint64_t>(n[2]) << 42) + (static_cast<uint64_t>(n[1]) << 21) + static_cast<uint64_t>(n[0]);
    };
    // The sum of its ends is twice its middle, which is no other edge's.
    const auto [at, is_new] =
        vertices_.try_emplace(number(inside) + number(outside), static_cast<uint32_t>(mesh_.positions.size()));
    if (is_new) {
      const Vec3 p = crossing(place(inside), value(inside, lower_z), place(outside), value(outside, lower_z));
      mesh_.positions.push_back(p);
      mesh_.normals.push_back(body_.normal(p, 0.25f * cell_));
    }
    return at->second;
  }

  /// Where the field is zero between a (negative there) and b, by the rule of false position. Small triangles near a
  /// node are askew where this is rough.
  Vec3 crossing(const Vec3& a, float value_a, const Vec3& b, float value_b) const {
    constexpr float kMargin = 1e-3f;  // off the nodes, where several vertices would be one
    constexpr int kSteps = 3;
    float below = 0, above = 1, t = 0;
    for (int i = 0; i < kSteps; ++i) {
      t = std::clamp(below + (above - below) * value_a / (value_a - value_b), kMargin, 1 - kMargin);
      const float at_t = body_(a + (b - a) * t);
      (at_t < 0 ? below : above) = t;
      (at_t < 0 ? value_a : value_b) = at_t;
    }
    return a + (b - a) * t;
  }

  const Body& body_;
  float cell_;
  Vec3 origin_;
  std::array<int, 3> size_{};
  std::vector<float> below_, above_;  ///< the field at the two layers of nodes in work
  std::unordered_map<uint64_t, uint32_t> vertices_;
  MeshData mesh_;
};

}  // namespace

MeshData make_limbs(std::span<const Limb> limbs, float blend, float cell, const Relief& relief) {
  require(!limbs.empty(), "limbs: needs at least one");
  for (const Limb& limb : limbs) {
    require(limb.from_radius > 0 && limb.to_radius > 0, "limbs: the radii must be positive");
    require(limb.from != limb.to || limb.from_radius == limb.to_radius,
            "limbs: the two ends of a limb are at one place");
  }
  require(blend > 0, "limbs: the blend must be positive");
  const Body body(limbs, blend, relief);
  require(cell > 0 && max_component(body.bounds().size()) / cell <= 4096,
          "limbs: the cells must be positive, and at most 4096 along a side");
  return Polygoniser(body, cell).run();
}

}  // namespace turbid
