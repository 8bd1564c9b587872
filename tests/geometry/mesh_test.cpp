#include <gtest/gtest.h>

#include "core/log.h"
#include "shapes_for_tests.h"

namespace turbid {
namespace {
using namespace turbid::testing;

MeshData one_triangle() {
  MeshData m;
  m.name = "one";
  m.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  m.indices = {0, 1, 2};
  return m;
}

std::string refusal(const MeshData& m) {
  try {
    const TriangleMesh mesh(m);
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "accepted";
}

TEST(TriangleMesh, RefusesWhatIsNoMesh) {
  EXPECT_EQ(refusal(one_triangle()), "accepted");
  MeshData m = one_triangle();
  m.positions[1].y = std::nanf("");
  EXPECT_EQ(refusal(m), "mesh 'one': the position of vertex 1 is not finite: (1, nan, 0)");
  m = one_triangle();
  m.positions[2].z = 2e18f;
  EXPECT_EQ(refusal(m), "mesh 'one': the position of vertex 2 is beyond 1e+18: (0, 1, 2e+18)");
  m = one_triangle();
  m.indices[1] = 3;
  EXPECT_EQ(refusal(m), "mesh 'one': triangle 0 refers to vertex 3, but there are 3");
  m = one_triangle();
  m.indices.push_back(0);
  EXPECT_EQ(refusal(m), "mesh 'one': the number of indices is not a multiple of 3");
  m = one_triangle();
  m.indices = {};
  EXPECT_EQ(refusal(m), "mesh 'one': there are no triangles");
  m = one_triangle();
  m.indices = {0, 1, 1};
  EXPECT_EQ(refusal(m), "mesh 'one': all triangles are degenerate (without area)");
  m = one_triangle();
  m.normals = {{0, 0, 1}};
  EXPECT_EQ(refusal(m), "mesh 'one': 1 vertex normals for 3 vertices");
  m = one_triangle();
  m.uvs = {{0, 0}};
  EXPECT_EQ(refusal(m), "mesh 'one': 1 texture coordinates for 3 vertices");
  m = one_triangle();
  m.attributes = {{"vertex_color", 3, false, {1, 2, 3}}};
  EXPECT_EQ(refusal(m), "mesh 'one': attribute 'vertex_color' has 3 values of 3 channels, expected 9");
}

TEST(TriangleMesh, DropsTrianglesWithoutArea) {
  set_log_level(LogLevel::kQuiet);
  MeshData m = make_rectangle();
  m.indices.insert(m.indices.begin(), {0, 1, 1});
  m.indices.insert(m.indices.end() - 3, {2, 2, 2});
  m.attributes = {{"face_id", 1, true, {9, 0, 9, 1}}};
  const TriangleMesh mesh(m);
  set_log_level(LogLevel::kWarnings);
  ASSERT_EQ(mesh.triangle_count(), 2u);
  EXPECT_EQ(mesh.area(), 4);
  EXPECT_EQ(mesh.eval_attribute(*mesh.attribute("face_id"), mesh.point_on_triangle(0, {0.2f, 0.2f})), Vec3(0.0f));
  EXPECT_EQ(mesh.eval_attribute(*mesh.attribute("face_id"), mesh.point_on_triangle(1, {0.2f, 0.2f})), Vec3(1.0f));
  EXPECT_EQ(mesh.attribute("face_none"), nullptr);
}

TEST(TriangleMesh, KnowsWhetherItIsClosed) {
  EXPECT_TRUE(TriangleMesh(make_cube()).is_closed());  // 24 vertices at 8 positions
  EXPECT_FALSE(TriangleMesh(make_rectangle()).is_closed());
  MeshData open = make_cube();
  open.indices.resize(open.indices.size() - 3);
  EXPECT_FALSE(TriangleMesh(open).is_closed());
  MeshData turned = make_cube();
  std::swap(turned.indices[0], turned.indices[1]);
  EXPECT_FALSE(TriangleMesh(turned).is_closed());
}

TEST(TriangleMesh, InterpolatesNormalsAndUvs) {
  MeshData m = one_triangle();
  m.normals = {{0, 0, 1}, {1, 0, 1}, {0, 0, 3}};
  m.uvs = {{0, 0}, {2, 0}, {0, 4}};
  const TriangleMesh mesh(m);
  const SurfacePoint s = mesh.point_on_triangle(0, {0.5f, 0.25f});
  EXPECT_EQ(s.p, Vec3(0.5f, 0.25f, 0));
  EXPECT_EQ(s.ng, Vec3(0, 0, 1));
  EXPECT_LT(length(s.shading.n - normalize(Vec3(0.5f, 0, 1.5f))), 1e-6f);
  EXPECT_EQ(s.uv, Vec2(1, 1));
  EXPECT_EQ(s.dp_du, Vec3(0.5f, 0, 0));
  EXPECT_EQ(s.dp_dv, Vec3(0, 0.25f, 0));
  EXPECT_NEAR(dot(s.shading.s, s.shading.n), 0, 1e-6f);
  EXPECT_GT(dot(s.shading.s, s.dp_du), 0);
  EXPECT_LT(length(cross(s.shading.s, s.shading.t) - s.shading.n), 1e-6f);
}

TEST(TriangleMesh, ShadingNormalsStayInFront) {
  MeshData m = one_triangle();
  m.normals = {{0, 0, 1}, {0, 0, 1}, {1, 0, -0.5f}};
  const TriangleMesh mesh(m);
  const SurfacePoint s = mesh.point_on_triangle(0, {0, 0.9f});
  EXPECT_GT(dot(s.shading.n, s.ng), 0);
  EXPECT_GT(s.shading.n.x, 0.9f);
  EXPECT_NEAR(length(s.shading.n), 1, 1e-6f);
  // Useless normals are replaced by the face's.
  m.normals = {{0, 0, 0}, {std::nanf(""), 0, 1}, {0, 0, 0}};
  EXPECT_EQ(TriangleMesh(m).point_on_triangle(0, {0.3f, 0.3f}).shading.n, Vec3(0, 0, 1));
}

/// Outward side of the first triangle of a cube-like mesh around the origin?
bool points_out(const TriangleMesh& mesh) {
  const SurfacePoint s = mesh.point_on_triangle(0, {0.3f, 0.3f});
  EXPECT_GT(dot(s.ng, s.shading.n), 0);
  return dot(s.ng, s.p) > 0;
}

TEST(TriangleMesh, OrientationRules) {
  set_log_level(LogLevel::kQuiet);
  EXPECT_TRUE(points_out(TriangleMesh(make_cube())));
  EXPECT_FALSE(points_out(TriangleMesh(make_cube(), true)));
  EXPECT_TRUE(points_out(TriangleMesh(make_cube(Transform::scale(-1, 2, 1)))));  // a mirror keeps the outside outside
  // Conflicts: a closed mesh is turned outside, whichever was wrong.
  MeshData inward_normals = make_cube(), inward_winding = make_cube();
  for (Vec3& n : inward_normals.normals) n = -n;
  for (size_t i = 0; i < inward_winding.indices.size(); i += 3)
    std::swap(inward_winding.indices[i], inward_winding.indices[i + 1]);
  EXPECT_TRUE(points_out(TriangleMesh(inward_normals)));
  EXPECT_TRUE(points_out(TriangleMesh(inward_winding)));
  EXPECT_FALSE(points_out(TriangleMesh(inward_winding, true)));
  // No conflict, but inside out: meant so.
  MeshData both = inward_winding;
  for (Vec3& n : both.normals) n = -n;
  EXPECT_FALSE(points_out(TriangleMesh(both)));
  // An open mesh follows its vertex normals.
  MeshData sheet = make_rectangle();
  for (Vec3& n : sheet.normals) n = -n;
  EXPECT_EQ(TriangleMesh(sheet).point_on_triangle(0, {0.3f, 0.3f}).ng, Vec3(0, 0, -1));
  set_log_level(LogLevel::kWarnings);
}

TEST(MeshData, ComputedNormalsAreWeightedByAngle) {
  // A cube with shared corners: angle weights give the diagonals, whichever way its squares are cut.
  MeshData m;
  for (int i = 0; i < 8; ++i)
    m.positions.push_back({float(i & 1) * 2 - 1, float(i >> 1 & 1) * 2 - 1, float(i >> 2) * 2 - 1});
  m.indices = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
               2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
  compute_vertex_normals(m);
  for (size_t i = 0; i < 8; ++i) EXPECT_LT(length(m.normals[i] - normalize(m.positions[i])), 1e-6f) << i;
}

TEST(MeshData, NormalsTransformByTheInverseTranspose) {
  MeshData m = one_triangle();
  m.positions = {{0, 0, 0}, {1, 0, 1}, {0, 1, 0}};  // normal (-1, 0, 1)
  m.normals.assign(3, normalize(Vec3(-1, 0, 1)));
  transform_mesh(m, Transform::translate(5, 6, 7) * Transform::scale(2, 1, 1));
  EXPECT_EQ(m.positions[1], Vec3(7, 6, 8));
  EXPECT_LT(length(m.normals[0] - normalize(Vec3(-1, 0, 2))), 1e-6f);
}

TEST(BasicMeshes, FollowMitsuba) {
  const TriangleMesh rectangle(make_rectangle());
  EXPECT_EQ(rectangle.area(), 4);
  for (const Vec2& b : {Vec2(0.1f, 0.2f), Vec2(0.6f, 0.3f)})
    for (uint32_t t = 0; t < 2; ++t) {
      const SurfacePoint s = rectangle.point_on_triangle(t, b);
      EXPECT_LT((s.uv - Vec2(s.p.x + 1, s.p.y + 1) * 0.5f).length(), 1e-6f);
      EXPECT_EQ(s.dp_du, Vec3(2, 0, 0));
      EXPECT_EQ(s.dp_dv, Vec3(0, 2, 0));
      EXPECT_EQ(s.ng, Vec3(0, 0, 1));
    }
  const TriangleMesh cube(make_cube());
  EXPECT_EQ(cube.area(), 24);
  for (uint32_t t = 0; t < 12; ++t) {
    const SurfacePoint s = cube.point_on_triangle(t, {0.3f, 0.3f});
    EXPECT_FLOAT_EQ(dot(s.ng, s.p), 1);
    EXPECT_EQ(s.ng, s.shading.n);
    if (s.ng == Vec3(0, 1, 0)) {
      EXPECT_LT((s.uv - Vec2(1 - s.p.x, 1 - s.p.z) * 0.5f).length(), 1e-6f);
    }
  }
}
}  // namespace
}  // namespace turbid
