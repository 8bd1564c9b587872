#pragma once
#include "texture/byte_reader.h"

namespace turbid {

/// The stored form of the values of one node of a VDB tree (OpenVDB's file versions 222 to 224).
struct VdbEncoding {
  bool zip = false, blosc = false;
  bool active_mask = false;  ///< values of inactive voxels are left out
  bool half = false;         ///< half floats instead of floats
  int channels = 1;
  std::vector<float> background;  ///< `channels` numbers
};

/// Bits of a node, one per child or voxel.
class VdbMask {
 public:
  VdbMask(ByteReader& file, size_t bits) {
    const std::span<const char> bytes = file.take(bits / 8);
    bytes_.assign(bytes.begin(), bytes.end());
  }
  bool on(size_t i) const { return (static_cast<unsigned char>(bytes_[i / 8]) >> (i % 8)) & 1; }
  size_t size() const { return 8 * bytes_.size(); }
  size_t count() const;

 private:
  std::vector<char> bytes_;
};

/// A string with its length in front.
std::string read_vdb_string(ByteReader& file);

/// Reads the values of a node, `channels` numbers for each bit of `active`.
std::vector<float> read_vdb_values(ByteReader& file, const VdbEncoding& encoding, const VdbMask& active);

}  // namespace turbid
