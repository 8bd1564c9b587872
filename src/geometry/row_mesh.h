#pragma once
#include "geometry/mesh_data.h"

namespace turbid {

/// Builds a mesh of rows of vertices that are joined to their predecessors. Columns grow so that (next row - this row)
/// x (next column - this column) points outside. Rows may shrink to a point: triangles without area are left out.
class RowMesh {
 public:
  explicit RowMesh(std::string name) { mesh_.name = std::move(name); }

  void add(const Vec3& p, const Vec3& n, const Vec2& uv) {
    mesh_.positions.push_back(p);
    mesh_.normals.push_back(n);
    mesh_.uvs.push_back(uv);
  }

  /// Joins the row of `columns` vertices that begins at `upper` to the one that begins at `lower`.
  void join(uint32_t lower, uint32_t upper, uint32_t columns) {
    for (uint32_t j = 0; j + 1 < columns; ++j) {
      triangle(lower + j, upper + j, upper + j + 1);
      triangle(lower + j, upper + j + 1, lower + j + 1);
    }
  }

  uint32_t size() const { return static_cast<uint32_t>(mesh_.positions.size()); }
  MeshData take() { return std::move(mesh_); }

 private:
  void triangle(uint32_t a, uint32_t b, uint32_t c) {
    const auto& p = mesh_.positions;
    if (p[a] == p[b] || p[b] == p[c] || p[c] == p[a]) return;
    mesh_.indices.insert(mesh_.indices.end(), {a, b, c});
  }

  MeshData mesh_;
};

/// Throws std::invalid_argument with the message unless the condition holds.
void require(bool condition, const std::string& message);

}  // namespace turbid
