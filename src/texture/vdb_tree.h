#pragma once
#include "texture/grid_voxels.h"
#include "texture/vdb_stream.h"

namespace turbid {

/// The voxels of a VDB tree and the index of the first one.
struct VdbVoxels {
  GridVoxels voxels;
  Voxel origin;
};

/// Reads a tree of OpenVDB's usual shape (root, 32^3, 16^3, leaves of 8^3) at the reader's place: topology, then the
/// leaves' values. The grid spans the leaves and the tiles that differ from the background, with a layer of one brick
/// of background around. Values keep their precision (half or float). Throws FileError.
VdbVoxels read_vdb_tree(ByteReader& file, VdbEncoding encoding);

}  // namespace turbid
