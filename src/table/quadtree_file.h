#pragma once
#include <span>
#include <string>

#include "table/quadtree_table.h"

namespace turbid {

/// Raised whenever the format of files changes, or what is in them: it is part of their names.
inline constexpr int kQuadtreeVersion = 2;

/// A table of mode `seed` as an HDF5 file in memory: version, what it was made of, and per source kind the data sets
/// "nodes", "lobes" and "factors" with what they hold in words; compressed, with a checksum over all of it.
std::string encode_quadtree(const QuadtreeTable& table);

/// The table in such bytes. Throws FileError in the name of `path` when they are damaged, cut off, of another version
/// or no such table at all.
QuadtreeTable decode_quadtree(std::span<const char> bytes, const std::string& path);

}  // namespace turbid
