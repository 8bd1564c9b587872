// Does the search find every path? Newton's method from many starts on every triangle says which paths there are.
#include <gtest/gtest.h>

#include "geometry/generated.h"
#include "refraction/half_vector.h"
#include "refraction/position_normal_tree.h"
#include "refraction/random_facets.h"
#include "refraction/triangle_filter.h"

namespace turbid::testing {
namespace {

struct Setting {
  std::string name;
  MeshData mesh;
  double eta;
  bool light_inside;
  bool at_infinity = false;
};

std::vector<Setting> settings() {
  const auto bumpy = [](int subdivisions) { return make_bumpy_sphere(1, 0.2f, 3, 1, subdivisions); };
  return {{"sphere", make_icosphere(1, 1), 1.4, false},
          {"bumpy sphere", bumpy(2), 1.4, false},
          {"sun on a bumpy sphere", bumpy(2), 1.33, false, true},
          {"light in a bumpy sphere", bumpy(2), 1 / 1.4, true},
          {"light in a bubble", bumpy(1), 1.4, true},
          {"bubble", bumpy(2), 1 / 1.33, false}};
}

/// A segment on the side where the light does not stand.
Segment random_segment(RandomFacets& random, bool light_inside) {
  if (light_inside) {
    const V3d from = random.direction() * random.uniform(1.5, 2.5), to = random.direction() * random.uniform(1.5, 2.5);
    return {{from, (to - from).normalized()}, 0, (to - from).length()};
  }
  const V3d from = random.direction() * 0.75, to = random.direction() * 0.75;
  return {{from, (to - from).normalized()}, 0, (to - from).length()};
}

LightPoint random_light(RandomFacets& random, const Setting& setting) {
  if (setting.at_infinity) return {random.direction(), true};
  return {random.direction() * (setting.light_inside ? random.uniform(0, 0.5) : random.uniform(1.5, 4)), false};
}

/// Which places of its facet a path may cross more than the brute-force search resolves.
bool is_marginal(const Pencil::Ray& ray) { return ray.cos_light < 1e-3 || ray.cos_refracted < 1e-3; }

struct Count {
  int existing = 0, in_tree = 0, on_contour = 0, by_newton = 0;
};

/// For one V on a segment: all paths through the mesh, and which of them the search knows.
void count_paths(const TriangleMesh& mesh, const PositionNormalTree& tree, const Setting& setting, RandomFacets& random,
                 int starts_per_side, Count& count) {
  const LightPoint light = random_light(random, setting);
  const Segment segment = random_segment(random, setting.light_inside);
  const double t = random.uniform(segment.from, segment.to);
  std::vector<bool> visited(mesh.triangle_count());
  tree.visit(light, setting.eta, setting.light_inside, segment,
             [&](uint32_t triangle, double, double) { visited[triangle] = true; });
  ContourFinder finder;
  for (uint32_t triangle = 0; triangle < mesh.triangle_count(); ++triangle) {
    const Facet outward = facet_of(mesh, triangle), facet = setting.light_inside ? outward.flipped() : outward;
    const V3d to_light = light.at_infinity ? light.place : light.place - facet.p0;
    if (!(to_light.dot(facet.ng) > 0) || !((segment.line.at(t) - facet.p0).dot(facet.ng) < 0)) continue;
    const HalfVector function(facet, light, setting.eta, segment.line);
    const Pencil pencil(facet, light, setting.eta);
    std::vector<V2d> roots;
    for (int i = 0; i < starts_per_side; ++i)
      for (int j = 0; i + j < starts_per_side; ++j) {
        const auto at = function.solve(t, V2d(i + 1.0 / 3, j + 1.0 / 3) / starts_per_side);
        if (!at || !inside_triangle(*at, -1e-9)) continue;
        const Pencil::Ray ray = pencil.ray(*at);
        const V3d to_v = segment.line.at(t) - ray.p;
        if (!pencil.valid(ray) || is_marginal(ray)) continue;
        // f is zero, too, where V lies on the light's side in the mirror image of the refracted direction.
        if (!(to_v.normalized().dot(ray.direction) > 1 - 1e-9)) continue;
        if (std::none_of(roots.begin(), roots.end(), [&](const V2d& known) { return (known - *at).length() < 1e-6; }))
          roots.push_back(*at);
      }
    if (roots.empty()) continue;
    const auto by_newton = function.solve(t, V2d(1.0 / 3));
    const TriangleFilter filter(mesh, light, setting.eta, setting.light_inside, segment);
    if (filter.may_contribute(std::array{triangle}) == 0) {
      count.existing += static_cast<int>(roots.size());
      continue;
    }
    const std::vector<ContourPiece> pieces = finder.find(pencil, segment);
    for (const V2d& root : roots) {
      ++count.existing;
      count.in_tree += visited[triangle];
      count.by_newton += by_newton && (*by_newton - root).length() < 1e-6;
      count.on_contour += std::any_of(pieces.begin(), pieces.end(), [&](const ContourPiece& piece) {
        // The point of the piece that lies across from the root is the root.
        const double x = (root - piece.start).cross(piece.across) / (piece.end - piece.start).cross(piece.across);
        if (!(x >= piece.from - 1e-6 && x <= piece.to + 1e-6)) return false;
        const auto point = ContourFinder::point(pencil, segment.line, piece, x);
        return point && (point->at - root).length() < 1e-6 && std::abs(point->encounter.on_line - t) < 1e-5;
      });
    }
  }
}

Count count_paths(const Setting& setting, int rays, int starts_per_side) {
  RandomFacets random(5);
  const TriangleMesh mesh(setting.mesh);
  const PositionNormalTree tree(mesh);
  Count count;
  for (int i = 0; i < rays; ++i) count_paths(mesh, tree, setting, random, starts_per_side, count);
  std::printf("%-24s %6d paths: %.4f %% found; Newton from the middle of each triangle: %.2f %%\n",
              setting.name.c_str(), count.existing, 100.0 * count.on_contour / count.existing,
              100.0 * count.by_newton / count.existing);
  EXPECT_GT(count.existing, rays / 4) << setting.name;
  EXPECT_EQ(count.in_tree, count.existing) << setting.name;
  EXPECT_GE(count.on_contour, 0.999 * count.existing) << setting.name;
  return count;
}

TEST(Completeness, OfPathsThroughMeshes) {
  int existing = 0, by_newton = 0;
  for (const Setting& setting : settings()) {
    const Count count = count_paths(setting, 40, 5);
    existing += count.existing;
    by_newton += count.by_newton;
  }
  EXPECT_LT(by_newton, existing) << "the brute force finds no more than a plain search: is it broken?";
}

class SlowCompleteness : public ::testing::TestWithParam<size_t> {};
// 1000 rays and 256 starts (22 + 21 + ... is 253).
TEST_P(SlowCompleteness, OfPathsThroughAMesh) { count_paths(settings()[GetParam()], 1000, 22); }
INSTANTIATE_TEST_SUITE_P(Slow, SlowCompleteness, ::testing::Range(size_t{0}, settings().size()));

TEST(PositionNormalTree, IsSmallAndHoldsItsTriangles) {
  for (const int subdivisions : {0, 3, 5}) {
    const TriangleMesh mesh(make_bumpy_sphere(1, 0.2f, 3, 1, subdivisions));
    const PositionNormalTree tree(mesh);
    tree.validate(mesh);
    EXPECT_EQ(tree.triangle_count(), mesh.triangle_count());
    if (subdivisions > 0) {
      EXPECT_LT(tree.bytes(), mesh.triangle_count() * PositionNormalTree::kMaxBytesPerTriangle);
    }
    const TriangleMesh other(make_bumpy_sphere(1.1f, 0.2f, 3, 1, subdivisions));
    EXPECT_THROW(tree.validate(other), std::logic_error);
  }
}

TEST(PositionNormalTree, AsksFewTriangles) {
  // The contour of a segment crosses about the root of their number.
  const auto asked = [](int subdivisions) {
    const TriangleMesh mesh(make_bumpy_sphere(1, 0.2f, 3, 1, subdivisions));
    const PositionNormalTree tree(mesh);
    RandomFacets random(9);
    double sum = 0;
    for (int i = 0; i < 50; ++i)
      tree.visit({random.direction() * 2.5, false}, 1.4, false, random_segment(random, false),
                 [&](uint32_t, double, double) { ++sum; });
    return sum;
  };
  const double exponent = std::log(asked(7) / asked(4)) / std::log(64.0);
  EXPECT_LT(exponent, 0.6);
  EXPECT_GT(exponent, 0.25);
}

}  // namespace
}  // namespace turbid::testing
