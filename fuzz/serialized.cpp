// Mitsuba's serialized meshes. They are compressed, and the fuzzer would seldom get past zlib's checksum: the first
// byte says whether the rest is a file as it stands (0), or what a file of one mesh (version 3: 1, version 4: 2) holds
// before it is compressed.
#include <zlib.h>

#include <vector>

#include "geometry/mesh_file.h"
#include "mesh_target.h"

namespace {

std::vector<uint8_t> compressed_file(uint8_t version, const uint8_t* content, size_t size) {
  const uint8_t header[] = {0x1c, 0x04, version, 0};
  uLongf length = compressBound(size);
  std::vector<uint8_t> file(sizeof header + length);
  std::copy(std::begin(header), std::end(header), file.begin());
  if (compress2(file.data() + sizeof header, &length, content, size, 1) != Z_OK) std::abort();
  file.resize(sizeof header + length);
  file.insert(file.end(), {0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0});  // contents: one mesh, at the beginning
  return file;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  if (size == 0) return 0;
  std::vector<uint8_t> file(bytes + 1, bytes + size);
  if (bytes[0] % 3 != 0) file = compressed_file(bytes[0] % 3 == 1 ? 3 : 4, bytes + 1, size - 1);
  return turbid::fuzzing::read_mesh(file.data(), file.size(),
                                    [](const std::string& path) { return turbid::load_serialized(path, 0); });
}
