#pragma once
#include <span>
#include <string>

#include "table/scattering_table.h"

namespace turbid {

/// Raised whenever the format of files changes, or what is in them: it is part of their names.
inline constexpr int kTableVersion = 3;

/// A table as an HDF5 file in memory: version, shape, Legendre moments, seed, and per source kind the data sets
/// "density", "largest", "ratios" with what they hold in words; compressed, with a checksum over all of it. The bytes
/// depend on the table alone.
std::string encode_table(const ScatteringTable& table);

/// The table in such bytes. Throws FileError in the name of `path` when they are damaged, cut off, of another version
/// or no table at all.
ScatteringTable decode_table(std::span<const char> bytes, const std::string& path);

}  // namespace turbid
