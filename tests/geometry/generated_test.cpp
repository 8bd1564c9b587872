#include <gtest/gtest.h>

#include "shapes_for_tests.h"

namespace turbid {
namespace {
using namespace turbid::testing;

double volume(const MeshData& m) {
  double sum = 0;
  for (size_t i = 0; i < m.indices.size(); i += 3) {
    const Imath::V3d a(m.positions[m.indices[i]]), b(m.positions[m.indices[i + 1]]), c(m.positions[m.indices[i + 2]]);
    sum += a.dot(b.cross(c)) / 6;
  }
  return sum;
}

/// Closed, outward, and with vertex normals near the faces'.
void expect_proper(const MeshData& data, double expected_volume, double tolerance, float least_cosine = 0.5f) {
  const TriangleMesh mesh(data);
  EXPECT_EQ(mesh.triangle_count(), data.triangle_count()) << data.name << " has degenerate triangles";
  EXPECT_TRUE(mesh.is_closed()) << data.name;
  EXPECT_TRUE(mesh.has_vertex_normals());
  EXPECT_NEAR(volume(data), expected_volume, tolerance * expected_volume) << data.name;
  for (size_t i = 0; i < data.indices.size(); i += 3) {
    const Vec3 a = data.positions[data.indices[i]], b = data.positions[data.indices[i + 1]],
               c = data.positions[data.indices[i + 2]];
    for (size_t k = 0; k < 3; ++k)
      ASSERT_GT(dot(normalize(cross(b - a, c - a)), data.normals[data.indices[i + k]]), least_cosine)
          << data.name << ' ' << i;
  }
}

TEST(Generated, ClosedShapesHaveTheVolumeOfWhatTheyStandFor) {
  const double pi = std::numbers::pi;
  expect_proper(make_icosphere(2, 4), 32 * pi / 3, 0.01, 0.99f);
  expect_proper(make_uv_sphere(2, 64, 32), 32 * pi / 3, 0.01, 0.95f);
  expect_proper(make_torus(2, 0.5f, 64, 48), 2 * pi * pi * 2 * 0.25, 0.01, 0.95f);
  expect_proper(make_rounded_box({1, 2, 3}, 0.2f, 4),
                8 * 0.8 * 1.8 * 2.8 + 8 * 0.2 * (0.8 * 1.8 + 1.8 * 2.8 + 2.8 * 0.8) +
                    2 * pi * 0.04 * (0.8 + 1.8 + 2.8) + 4 * pi / 3 * 0.008,
                0.001, 0.95f);
  expect_proper(make_rounded_box({1, 1, 1}, 1, 6), 4 * pi / 3, 0.02, 0.95f);  // nothing left but the sphere
  // A cylinder with sharp rims, and a ring of square section.
  const Vec2 cylinder[] = {{0, 0}, {1, 0}, {1, 0}, {1, 2}, {1, 2}, {0, 2}};
  expect_proper(make_lathe(cylinder, 128), 2 * pi, 0.001, 0.99f);
  const Vec2 ring[] = {{1, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 0}};
  expect_proper(make_lathe(ring, 128), 3 * pi, 0.001);
  const Vec2 half_circle[] = {{0, -1}, {0.7071f, -0.7071f}, {1, 0}, {0.7071f, 0.7071f}, {0, 1}};
  expect_proper(make_lathe(smooth_profile(half_circle, 8), 64), 4 * pi / 3, 0.02, 0.9f);
  const Vec3 line[] = {{0, 0, 0}, {1, 1, 0}, {1.5f, 2, 0.5f}};
  const float radius = 0.05f;
  const double length_of_line = std::sqrt(2.0) + std::sqrt(1.5);
  expect_proper(make_tube(line, {&radius, 1}, 24), pi * 0.0025 * (length_of_line + 4.0 / 3 * 0.05), 0.05);
  EXPECT_TRUE(TriangleMesh(make_bumpy_sphere(1, 0.2f, 3, 1, 4)).is_closed());
  EXPECT_GT(volume(make_bumpy_sphere(1, 0.2f, 3, 1, 4)), 3);
}

TEST(Generated, GridsFollowTheirHeight) {
  const MeshData flat = make_grid({2, 3}, 4, 5);
  EXPECT_EQ(flat.triangle_count(), 40u);
  EXPECT_FLOAT_EQ(TriangleMesh(flat).area(), 24);
  EXPECT_GT(TriangleMesh(flat).point_on_triangle(0, {0.3f, 0.3f}).ng.y, 0.99f);
  const MeshData slope = make_grid({1, 1}, 4, 4, [](float x, float z) { return x + 2 * z; });
  for (const Vec3& n : slope.normals) EXPECT_LT(length(n - normalize(Vec3(-1, 1, -2))), 1e-5f);
}

TEST(Generated, NoiseIsSmoothAndBounded) {
  Rng rng(1);
  float largest = 0;
  for (int i = 0; i < 20'000; ++i) {
    const Vec3 p = random_in({Vec3(-20.0f), Vec3(20.0f)}, rng);
    const float v = smooth_noise(p, 1);
    largest = std::max(largest, std::abs(v));
    EXPECT_LT(std::abs(smooth_noise(p + Vec3(1e-3f, -1e-3f, 1e-3f), 1) - v), 0.01f);
    if (i == 0) {
      EXPECT_NE(smooth_noise(p, 2), v);
    }
  }
  EXPECT_LE(largest, 1);
  EXPECT_GT(largest, 0.6f);
}

TEST(Generated, KindsAreMadeByName) {
  for (const GeneratedShapeKind& kind : generated_shape_kinds()) {
    GeneratedShapeArguments arguments;
    if (kind.name == "lathe") arguments.points = {0, 0, 1, 1, 0, 2};
    if (kind.name == "tube") arguments.points = {0, 0, 0, 0, 1, 0};
    EXPECT_GT(TriangleMesh(make_generated(kind.name, arguments)).area(), 0) << kind.name;
  }
  EXPECT_THROW(make_generated("sphere", {}), std::invalid_argument);
  EXPECT_THROW(make_generated("torus", {.numbers = {{"radius", 1}}, .points = {}}), std::invalid_argument);
  EXPECT_THROW(make_generated("torus", {.numbers = {}, .points = {1, 2}}), std::invalid_argument);
  EXPECT_THROW(make_generated("lathe", {.numbers = {}, .points = {1, 2, 3}}), std::invalid_argument);
  EXPECT_THROW(make_generated("icosphere", {.numbers = {{"subdivisions", 1.5}}, .points = {}}), std::invalid_argument);
  try {
    make_generated("donut", {});
    FAIL();
  } catch (const std::invalid_argument& e) {
    EXPECT_STREQ(e.what(),
                 "there is no generated shape 'donut'; known are icosphere, uv_sphere, torus, lathe, rounded_box, "
                 "bumpy_sphere, grid, tube");
  }
}
}  // namespace
}  // namespace turbid
