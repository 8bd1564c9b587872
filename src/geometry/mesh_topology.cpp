#include "geometry/mesh_topology.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <bit>

#include "core/rng.h"

namespace turbid {
namespace {
using Imath::V3d;

/// For each vertex the lowest index of a vertex at the same position.
std::vector<uint32_t> merge_equal_positions(const std::vector<Vec3>& positions) {
  constexpr uint32_t kEmpty = ~0u;
  const size_t slots = std::bit_ceil(2 * positions.size() + 1);
  std::vector<uint32_t> table(slots, kEmpty), first(positions.size());
  for (uint32_t i = 0; i < positions.size(); ++i) {
    const Vec3 p = positions[i] + Vec3(0.0f);  // -0 becomes 0
    size_t slot =
        hash_counters(std::bit_cast<uint32_t>(p.x), std::bit_cast<uint32_t>(p.y), std::bit_cast<uint32_t>(p.z));
    for (slot &= slots - 1; table[slot] != kEmpty && positions[table[slot]] != positions[i];
         slot = (slot + 1) & (slots - 1)) {
    }
    if (table[slot] == kEmpty) table[slot] = i;
    first[i] = table[slot];
  }
  return first;
}

double squared_distance_to_segment(const V3d& a, const V3d& b) {
  const V3d edge = b - a;
  const double norm = edge.length2();
  const double s = norm > 0 ? std::clamp(-a.dot(edge) / norm, 0.0, 1.0) : 0.0;
  return (a + edge * s).length2();
}
}  // namespace

bool edges_are_paired(const MeshData& mesh) {
  const std::vector<uint32_t> vertex = merge_equal_positions(mesh.positions);
  std::vector<uint64_t> edges;
  edges.reserve(mesh.indices.size());
  for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
    for (size_t k = 0; k < 3; ++k) {
      const uint64_t from = vertex[mesh.indices[i + k]], to = vertex[mesh.indices[i + (k + 1) % 3]];
      if (from != to) edges.push_back(std::min(from, to) << 32 | std::max(from, to) << 1 | (from < to ? 1 : 0));
    }
  tbb::parallel_sort(edges.begin(), edges.end());
  for (size_t i = 0; i < edges.size();) {
    int balance = 0;
    const uint64_t edge = edges[i] >> 1;
    for (; i < edges.size() && edges[i] >> 1 == edge; ++i) balance += (edges[i] & 1) != 0 ? 1 : -1;
    if (balance != 0) return false;
  }
  return true;
}

double distance_to_triangle(const V3d& a, const V3d& b, const V3d& c) {
  const V3d ab = b - a, ac = c - a, n = ab.cross(ac);
  const double norm = n.length2();
  // Barycentric weights (times |n|^2) of the foot of the perpendicular.
  const double weight_b = -n.dot(a.cross(ac)), weight_c = -n.dot(ab.cross(a));
  if (norm > 0 && weight_b >= 0 && weight_c >= 0 && weight_b + weight_c <= norm)
    return std::abs(n.dot(a)) / std::sqrt(norm);
  return std::sqrt(std::min(
      {squared_distance_to_segment(a, b), squared_distance_to_segment(b, c), squared_distance_to_segment(c, a)}));
}

}  // namespace turbid
