#pragma once
#include <string>

#include "core/vector.h"
#include "texture/grid_voxels.h"

namespace turbid {

/// What a Mitsuba .vol file holds.
struct VolFile {
  GridVoxels voxels;
  Bounds3 box;  ///< where the file says that the grid stands; may be empty
};

/// Reads Mitsuba's grid format, version 3 (little endian): "VOL", 3, int32 encoding (1: float32, 2: float16, 3: uint8
/// for [0, 1]), int32 nx, ny, nz, channels, six float32 (box: min, max), then the values, x fastest, channels
/// interleaved. Throws FileError: not such a file, sizes that the file does not hold, channels other than 1 or 3,
/// values that are not finite.
VolFile read_vol(const std::string& path);

}  // namespace turbid
