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

TEST(Generated, SlabsEndBelowTheirHeight) {
  const WaveField waves({.length = 0.8f,
                         .amplitude = 0.06f,
                         .trains = 5,
                         .spread = 90,
                         .sharpness = 2,
                         .lean = 0.5f,
                         .bend = 0.1f,
                         .seed = 3});
  const MeshData slab = make_slab({1, 2}, 60, 120, 1, std::cref(waves));
  double mean = 0;
  Rng rng(2);
  constexpr int kSamples = 20'000;
  for (int i = 0; i < kSamples; ++i) mean += waves(2 * rng.next_float() - 1, 4 * rng.next_float() - 2) / kSamples;
  expect_proper(slab, 8 * (1 + mean), 0.005);
  EXPECT_THROW(make_slab({1, 1}, 8, 8, 0.03f, std::cref(waves)), std::invalid_argument);
}

TEST(Generated, WavesAreAsHighAsTheySayAndLeanToX) {
  const WaveField one({.length = 2, .amplitude = 0.3f, .trains = 1, .spread = 0, .lean = 0.6f});
  float highest = -1, lowest = 1, steepest = 0, least_steep = 0;
  for (int i = 0; i < 2000; ++i) {
    const float x = static_cast<float>(i) * 1e-3f, slope = (one(x + 1e-3f, 1) - one(x, 1)) / 1e-3f;
    EXPECT_NEAR(one(x, 1), one(x + 2, -3), 1e-5f);
    highest = std::max(highest, one(x, 1));
    lowest = std::min(lowest, one(x, 1));
    least_steep = std::max(least_steep, slope);
    steepest = std::min(steepest, slope);
  }
  EXPECT_NEAR(highest, 0.3f, 1e-4f);
  EXPECT_NEAR(lowest, -0.3f, 1e-4f);
  EXPECT_GT(-steepest, 1.5f * least_steep);
  EXPECT_THROW(WaveField({.length = 0}), std::invalid_argument);
  EXPECT_THROW(WaveField({.lean = 1}), std::invalid_argument);
}

TEST(Generated, LimbsHaveTheVolumeOfTheirUnion) {
  const double pi = std::numbers::pi;
  // Spheres as limbs of no length, alone and apart; a cone with round ends; two that melt, closed in any case.
  const Limb ball{{0.1f, 0.2f, 0.3f}, 0.5f, {0.1f, 0.2f, 0.3f}, 0.5f};
  expect_proper(make_limbs({&ball, 1}, 0.01f, 0.03f), pi / 6, 0.01);
  const Limb two[] = {ball, {{2, 0, 0}, 0.25f, {3, 0, 0}, 0.25f}};
  expect_proper(make_limbs(two, 0.01f, 0.03f), pi / 6 + pi / 16 + pi / 48, 0.01);
  const Limb elbow[] = {{{0, 0, 0}, 0.3f, {0, 1, 0}, 0.2f}, {{0, 1, 0}, 0.2f, {0.7f, 1.3f, 0.2f}, 0.1f}};
  EXPECT_TRUE(TriangleMesh(make_limbs(elbow, 0.1f, 0.03f, {0.02f, 5, 1})).is_closed());
  EXPECT_GT(volume(make_limbs(elbow, 0.1f, 0.03f)), volume(make_limbs({elbow, 1}, 0.1f, 0.03f)));
  EXPECT_THROW(make_limbs({}, 0.1f, 0.1f), std::invalid_argument);
  const Limb point{{0, 0, 0}, 0.1f, {0, 0, 0}, 0.2f};
  EXPECT_THROW(make_limbs({&point, 1}, 0.1f, 0.1f), std::invalid_argument);
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
    if (kind.name == "limbs") arguments.points = {0, 0, 0, 0.2, 0, 1, 0, 0.1};
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
                 "bumpy_sphere, grid, waves, limbs, tube");
  }
}
}  // namespace
}  // namespace turbid
