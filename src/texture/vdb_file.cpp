#include "texture/vdb_file.h"

#include <fmt/format.h>

#include <map>
#include <stdexcept>

#include "texture/vdb_tree.h"

namespace turbid {
namespace {

constexpr int64_t kMagic = 0x56444220;
constexpr uint32_t kOldestVersion = 222, kNewestVersion = 224;
constexpr size_t kUuidLength = 36;
constexpr uint32_t kZip = 1, kActiveMask = 2, kBlosc = 4;
const std::string kHalfSuffix = "_HalfFloat";

/// An entry of the file's table of contents.
struct Entry {
  std::string name, type;
  std::string instance_of;  ///< unique name of the grid whose tree this one shares; empty: its own
  int64_t position;
};

/// Names that occur more than once carry a separator and a number.
std::string plain_name(const std::string& unique) { return unique.substr(0, unique.find('\x1e')); }

void skip_metadata(ByteReader& file) {
  const auto count = file.read<uint32_t>();
  for (uint32_t i = 0; i < count; ++i) {
    read_vdb_string(file);  // name
    read_vdb_string(file);  // type
    file.take(file.read<uint32_t>());
  }
}

std::map<std::string, Entry> read_contents(ByteReader& file) {
  if (file.left() < sizeof(kMagic) || file.read<int64_t>() != kMagic) file.fail("not an OpenVDB file");
  const auto version = file.read<uint32_t>();
  if (version < kOldestVersion || version > kNewestVersion)
    file.fail(fmt::format("version {} of the OpenVDB format is not supported: {} to {} are", version, kOldestVersion,
                          kNewestVersion));
  file.take(2 * sizeof(uint32_t));  // version of the library
  if (file.read<char>() == 0) file.fail("OpenVDB streams without grid offsets are not supported");
  file.take(kUuidLength);
  skip_metadata(file);
  const auto count = file.read<uint32_t>();
  std::map<std::string, Entry> entries;
  for (uint32_t i = 0; i < count; ++i) {
    const std::string unique = read_vdb_string(file), type = read_vdb_string(file), parent = read_vdb_string(file);
    const auto position = file.read<int64_t>();
    file.take(sizeof(int64_t));  // of the leaves' values
    const auto end = file.read<int64_t>();
    if (position < 0 || end < 0) file.fail("damaged: a grid stands nowhere");
    entries.emplace(unique, Entry{plain_name(unique), type, parent, position});
    file.seek(static_cast<uint64_t>(end));
  }
  return entries;
}

Imath::V3d read_vector(ByteReader& file) {
  const auto x = file.read<double>(), y = file.read<double>(), z = file.read<double>();
  return {x, y, z};
}

Transform translation(const Imath::V3d& t) { return Transform::translate(t.x, t.y, t.z); }

/// From index space to world space.
Transform read_transform(ByteReader& file) {
  const std::string type = read_vdb_string(file);
  try {
    if (type == "AffineMap" || type == "UnitaryMap") {
      double m[4][4];  // OpenVDB multiplies row vectors from the left
      for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) m[column][row] = file.read<double>();
      return Transform(m);
    }
    if (type == "TranslationMap") return translation(read_vector(file));
    const bool translates = type == "ScaleTranslateMap" || type == "UniformScaleTranslateMap";
    if (!translates && type != "ScaleMap" && type != "UniformScaleMap")
      file.fail("a transform of type '" + type + "' is not supported");
    const Imath::V3d moved = translates ? read_vector(file) : Imath::V3d(0);
    const Imath::V3d scale = read_vector(file);
    file.take(4 * 3 * sizeof(double));  // what follows from the scale
    return translation(moved) * Transform::scale(scale.x, scale.y, scale.z);
  } catch (const std::invalid_argument&) {
    file.fail("the grid's transform is singular");
  }
}

VdbEncoding encoding_of(const ByteReader& file, const Entry& entry, uint32_t compression) {
  VdbEncoding encoding;
  std::string type = entry.type;
  if (type.ends_with(kHalfSuffix)) {
    encoding.half = true;
    type.resize(type.size() - kHalfSuffix.size());
  }
  if (type == "Tree_vec3s_5_4_3") {
    encoding.channels = 3;
  } else if (type != "Tree_float_5_4_3") {
    file.fail(fmt::format("grid '{}' is of type '{}': only float and vec3s grids are supported", entry.name, type));
  }
  encoding.zip = compression & kZip;
  encoding.blosc = compression & kBlosc;
  encoding.active_mask = compression & kActiveMask;
  return encoding;
}

/// Goes to a grid and reads what stands before its tree.
struct Head {
  uint32_t compression;
  Transform transform;
};
Head read_head(ByteReader& file, const Entry& entry) {
  file.seek(static_cast<uint64_t>(entry.position));
  const auto compression = file.read<uint32_t>();
  skip_metadata(file);
  return {compression, read_transform(file)};
}

}  // namespace

VdbGrid read_vdb(const std::string& path, const std::string& grid) {
  ByteReader file(path);
  const std::map<std::string, Entry> entries = read_contents(file);
  const Entry* entry = nullptr;
  std::string names;
  for (const auto& [unique, candidate] : entries) {
    names += (names.empty() ? "'" : ", '") + candidate.name + "'";
    if (!entry && candidate.name == grid) entry = &candidate;
  }
  if (!entry) file.fail("has no grid '" + grid + "', but " + (names.empty() ? "none at all" : names));

  const Transform to_world = read_head(file, *entry).transform;
  if (!entry->instance_of.empty()) {
    const auto parent = entries.find(entry->instance_of);
    if (parent == entries.end()) file.fail("damaged: grid '" + grid + "' shares the tree of one that is not there");
    entry = &parent->second;
  }
  const Head head = read_head(file, *entry);
  VdbVoxels tree = read_vdb_tree(file, encoding_of(file, *entry, head.compression));
  const Voxel &origin = tree.origin, &size = tree.voxels.size();
  const Transform to_index =
      Transform::translate(origin.x - 0.5, origin.y - 0.5, origin.z - 0.5) * Transform::scale(size.x, size.y, size.z);
  return {std::move(tree.voxels), to_world * to_index};
}

}  // namespace turbid
