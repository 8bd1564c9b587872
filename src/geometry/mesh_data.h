#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core/transform.h"
#include "core/vector.h"

namespace turbid {

/// Named numbers that belong to the vertices or the faces of a mesh: colours, masks ... `values` is channels x count
/// long.
struct MeshAttribute {
  std::string name;  ///< as in Mitsuba: begins with "vertex_" or "face_"
  int channels = 1;  ///< 1 or 3
  bool per_face = false;
  std::vector<float> values;
};

/// Triangles as plain arrays: what files and generators make and what a TriangleMesh is built from.
struct MeshData {
  std::string name;  ///< for messages: the file, or the kind of generated shape
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;      ///< empty, or one per position; need not be normalised
  std::vector<Vec2> uvs;          ///< empty, or one per position
  std::vector<uint32_t> indices;  ///< three per triangle, counter-clockwise when seen from outside
  std::vector<MeshAttribute> attributes;

  size_t triangle_count() const { return indices.size() / 3; }
};

/// Maps positions by `to_world` and normals by its inverse transpose. When the map changes the handedness, the
/// triangles are turned round so that the outside stays outside (Mitsuba 3 leaves them, which turns such a mesh inside
/// out).
void transform_mesh(MeshData& mesh, const Transform& to_world);

/// Replaces the normals by the mean of the normals of the triangles around each vertex, weighted by their angles there
/// (Thuermer & Wuethrich 1998). Vertices without a proper triangle get (0, 0, 0), which means: no vertex normal here.
void compute_vertex_normals(MeshData& mesh);

/// Turns the surface inside out: windings and normals.
void flip_mesh(MeshData& mesh);

}  // namespace turbid
