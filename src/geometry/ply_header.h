#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace turbid {

enum class PlyType : uint8_t { kInt8, kUInt8, kInt16, kUInt16, kInt32, kUInt32, kFloat32, kFloat64 };
size_t ply_size(PlyType type);
inline bool ply_is_integer(PlyType type) { return type != PlyType::kFloat32 && type != PlyType::kFloat64; }

struct PlyProperty {
  std::string name;
  PlyType type;
  bool is_list = false;
  PlyType count_type = PlyType::kUInt8;  ///< of lists
};

struct PlyElement {
  std::string name;
  uint64_t count;
  std::vector<PlyProperty> properties;

  /// Least number of bytes that one element takes in the file.
  size_t least_size(bool ascii) const;
  /// Index of a property, or -1.
  int find(std::string_view property) const;
};

/// The header of a PLY file.
struct PlyHeader {
  bool ascii = false, big_endian = false;
  std::vector<PlyElement> elements;
  size_t data_offset = 0;  ///< where the data begins
};

/// Parses the header of `bytes`, a whole file, and refuses one that claims more data than the file holds. Throws
/// FileError.
PlyHeader parse_ply_header(const std::filesystem::path& path, std::string_view bytes);

}  // namespace turbid
