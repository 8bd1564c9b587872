// OpenVDB files.
#include "core/error.h"
#include "memory_file.h"
#include "quiet.h"
#include "texture/grid_volume.h"
#include "texture/vdb_file.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  using namespace turbid;
  const fuzzing::MemoryFile file(bytes, size);
  for (const char* grid : {"density", "temperature", "color"}) {
    try {
      const GridVolume volume(read_vdb(file.path(), grid).voxels, {});
      volume.eval({0.3f, 0.6f, 0.9f});
      volume.range(volume.bounds());
    } catch (const FileError&) {
    }
  }
  return 0;
}
