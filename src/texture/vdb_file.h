#pragma once
#include <string>

#include "core/transform.h"
#include "texture/grid_voxels.h"

namespace turbid {

/// A grid of an OpenVDB file.
struct VdbGrid {
  GridVoxels voxels;
  Transform to_world;  ///< from the unit cube that the voxels fill to the file's world space
};

/// Reads the grid of that name (the first one of several) from an OpenVDB file: floats or 3-vectors of floats, whole or
/// half precision, plain, zip or blosc, in trees of the usual shape, with any affine transform. File versions 222
/// (OpenVDB 2.2, 2013) to 224 (today). In OpenVDB voxel i stands at index coordinate i; the cube reaches half a voxel
/// further. Throws FileError: not such a file, damaged, no grid of that name (it names those there are), a kind of grid
/// that is not supported.
///
/// Own code instead of OpenVDB's library, which alone takes longer to load (40 ms) than a program may to start.
VdbGrid read_vdb(const std::string& path, const std::string& grid);

}  // namespace turbid
