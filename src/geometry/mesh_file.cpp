#include "geometry/mesh_file.h"

namespace turbid {

void finish_loaded_mesh(MeshData& mesh, const std::filesystem::path& path, const MeshFileOptions& options) {
  mesh.name = path.filename().string();
  if (options.face_normals) mesh.normals = {};
  transform_mesh(mesh, options.to_world);
  if (mesh.normals.empty() && !options.face_normals) compute_vertex_normals(mesh);
}

}  // namespace turbid
