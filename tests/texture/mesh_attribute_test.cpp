// Numbers on vertices and faces as textures.
#include "texture/mesh_attribute.h"

#include <gtest/gtest.h>

#include "geometry/triangle_mesh.h"

namespace turbid {
namespace {

/// Two triangles of the unit square in the xy plane.
TriangleMesh square() {
  MeshData data;
  data.name = "square";
  data.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  data.indices = {0, 1, 2, 0, 2, 3};
  data.attributes = {{"vertex_height", 1, false, {0, 1, 3, 2}},
                     {"vertex_color", 3, false, {1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1}},
                     {"face_weight", 1, true, {0.25f, 0.75f}},
                     {"face_color", 3, true, {0.1f, 0.2f, 0.3f, 0.4f, 0.5f, 0.6f}}};
  return TriangleMesh(std::move(data));
}

TEST(MeshAttribute, InterpolatesVerticesAndKeepsFaces) {
  const TriangleMesh mesh = square();
  const SurfacePoint first = mesh.point_on_triangle(0, {0.25f, 0.5f});
  const SurfacePoint second = mesh.point_on_triangle(1, {0.25f, 0.5f});
  EXPECT_FLOAT_EQ(MeshAttributeTexture("vertex_height").eval_scalar(first), 0.25f + 1.5f);
  EXPECT_FLOAT_EQ(MeshAttributeTexture("vertex_height", 2).eval_scalar(second), 2 * (0.75f + 1));
  const Spectrum color = MeshAttributeTexture("vertex_color").eval(first);
  EXPECT_FLOAT_EQ(color[0], 0.25f);
  EXPECT_FLOAT_EQ(color[1], 0.25f);
  EXPECT_FLOAT_EQ(color[2], 0.5f);
  EXPECT_EQ(MeshAttributeTexture("face_weight").eval(first), Spectrum(0.25f));
  EXPECT_EQ(MeshAttributeTexture("face_weight").eval_scalar(second), 0.75f);
  EXPECT_EQ(MeshAttributeTexture("face_color").eval(second), Spectrum(0.4f, 0.5f, 0.6f));
  EXPECT_FLOAT_EQ(MeshAttributeTexture("face_color").eval_scalar(second), Spectrum(0.4f, 0.5f, 0.6f).luminance());
}

/// The same texture on several meshes: the point decides.
TEST(MeshAttribute, AsksTheMeshOfThePoint) {
  const TriangleMesh mesh = square();
  MeshData other = mesh.data();
  other.attributes[2].values = {5, 6};
  const TriangleMesh second(std::move(other));
  const MeshAttributeTexture weight("face_weight");
  EXPECT_EQ(weight.eval_scalar(mesh.point_on_triangle(0, {0.2f, 0.2f})), 0.25f);
  EXPECT_EQ(weight.eval_scalar(second.point_on_triangle(0, {0.2f, 0.2f})), 5);
  EXPECT_TRUE(weight.eval(SurfacePoint{}).is_black());
  EXPECT_TRUE(MeshAttributeTexture("vertex_other").eval(mesh.point_on_triangle(0, {0.2f, 0.2f})).is_black());
}

TEST(MeshAttribute, IsNamedAfterWhatItBelongsTo) {
  EXPECT_THROW(MeshAttributeTexture("color"), std::invalid_argument);
  EXPECT_THROW(MeshAttributeTexture(""), std::invalid_argument);
}

}  // namespace
}  // namespace turbid
