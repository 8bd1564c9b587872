#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/ray.h"

namespace turbid {

/// Finds, among many points, those near to a piece of a ray or to a place: a k-d tree that is split at medians, however
/// the points are spread, with a few points per leaf. It is the same for any number of threads. Queries are const and
/// thread-safe.
class PointTree {
 public:
  /// Takes the place of what was there.
  void build(std::span<const Vec3> points);
  bool empty() const { return items_.empty(); }

  /// Calls visit(number) for points that may lie within `radius` of the ray in [0, t_max], and for all that do.
  template <class Visit>
  void along(const Ray& ray, float radius, const Visit& visit) const;
  /// The same for points around a place.
  template <class Visit>
  void around(const Vec3& p, float radius, const Visit& visit) const;

 private:
  struct Item {
    Vec3 position;
    uint32_t number;
  };
  struct Node {
    float split;
    int axis;
  };
  static constexpr size_t kLeaf = 8;            ///< most points of a leaf
  static constexpr size_t kParallel = 1 << 14;  ///< least points of a part that is split by two threads
  static constexpr size_t kMostTasks = 64;      ///< two for each level
  static constexpr float kWider = 1.001f;       ///< of what is reported: the caller decides
  void split(size_t node, size_t from, size_t to);
  static size_t middle(size_t from, size_t to) { return from + (to - from) / 2; }

  std::vector<Item> items_;  ///< in the order of the leaves
  std::vector<Node> nodes_;  ///< children of node i: 2 i + 1 and 2 i + 2, each with half of the points
};

template <class Visit>
void PointTree::around(const Vec3& p, float radius, const Visit& visit) const {
  struct Task {
    size_t node, from, to;
  };
  if (empty()) return;
  std::array<Task, kMostTasks> stack;
  size_t count = 0;
  stack[count++] = {0, 0, items_.size()};
  while (count > 0) {
    const Task task = stack[--count];
    if (task.to - task.from <= kLeaf) {
      for (size_t i = task.from; i < task.to; ++i)
        if (length_squared(items_[i].position - p) <= kWider * sqr(radius)) visit(items_[i].number);
      continue;
    }
    const Node& node = nodes_[task.node];
    const size_t mid = middle(task.from, task.to);
    if (p[node.axis] - radius <= node.split) stack[count++] = {2 * task.node + 1, task.from, mid};
    if (p[node.axis] + radius >= node.split) stack[count++] = {2 * task.node + 2, mid, task.to};
  }
}

template <class Visit>
void PointTree::along(const Ray& ray, float radius, const Visit& visit) const {
  struct Task {
    size_t node, from, to;
    float t0, t1;
  };
  if (empty()) return;
  std::array<Task, kMostTasks> stack;
  size_t count = 0;
  stack[count++] = {0, 0, items_.size(), 0, ray.t_max};
  while (count > 0) {
    const Task task = stack[--count];
    if (task.to - task.from <= kLeaf) {
      for (size_t i = task.from; i < task.to; ++i) {
        const Vec3 to = items_[i].position - ray.origin;
        const float t = std::clamp(dot(to, ray.direction), task.t0, task.t1);
        if (length_squared(to - ray.direction * t) <= kWider * sqr(radius)) visit(items_[i].number);
      }
      continue;
    }
    const Node& node = nodes_[task.node];
    const size_t mid = middle(task.from, task.to);
    const float o = ray.origin[node.axis], d = ray.direction[node.axis];
    const float a = o + d * task.t0, b = o + d * task.t1;
    // The half spaces that begin `radius` before the plane, and the part of the ray in each.
    const auto push = [&](bool upper) {
      const float plane = upper ? node.split - radius : node.split + radius;
      const bool in_a = upper ? a >= plane : a <= plane, in_b = upper ? b >= plane : b <= plane;
      if (!in_a && !in_b) return;
      float t0 = task.t0, t1 = task.t1;
      if (!in_a || !in_b) {
        // Cut generously: rounding must lose no point.
        const float cut = (plane - o) / d, slack = 1e-4f * (t1 - t0) + radius;
        if (in_a)
          t1 = std::min(t1, cut + slack);
        else
          t0 = std::max(t0, cut - slack);
      }
      stack[count++] =
          upper ? Task{2 * task.node + 2, mid, task.to, t0, t1} : Task{2 * task.node + 1, task.from, mid, t0, t1};
    };
    push(false);
    push(true);
  }
}

}  // namespace turbid
