#pragma once
#include <stdexcept>

#include "core/error.h"
#include "geometry/triangle_mesh.h"
#include "memory_file.h"
#include "quiet.h"

namespace turbid::fuzzing {

/// A mesh reader must refuse the bytes with a FileError, or make a mesh that TriangleMesh takes or refuses in an
/// orderly way and whose surface can be asked for points.
template <class Load>
int read_mesh(const uint8_t* bytes, size_t size, const Load& load) {
  const MemoryFile file(bytes, size);
  try {
    const TriangleMesh mesh(load(file.path()));
    mesh.is_closed();
    mesh.point_on_triangle(static_cast<uint32_t>(mesh.triangle_count() - 1), {0.3f, 0.3f});
    const SurfacePoint point = mesh.sample_area({0.3f, 0.7f}).point;
    for (const MeshAttribute& attribute : mesh.data().attributes) mesh.eval_attribute(attribute, point);
  } catch (const FileError&) {
  } catch (const std::invalid_argument&) {
  }
  return 0;
}

}  // namespace turbid::fuzzing
