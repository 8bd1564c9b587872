// PLY meshes.
#include "geometry/mesh_file.h"
#include "mesh_target.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  return turbid::fuzzing::read_mesh(bytes, size, [](const std::string& path) { return turbid::load_ply(path); });
}
