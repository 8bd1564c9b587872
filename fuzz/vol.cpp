// Mitsuba's .vol grids.
#include "core/error.h"
#include "memory_file.h"
#include "quiet.h"
#include "texture/grid_volume.h"
#include "texture/vol_file.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  using namespace turbid;
  const fuzzing::MemoryFile file(bytes, size);
  try {
    const GridVolume volume(read_vol(file.path()).voxels, {});
    volume.eval({0.3f, 0.6f, 0.9f});
    volume.range(volume.bounds());
  } catch (const FileError&) {
  }
  return 0;
}
