#include "texture/vdb_tree.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace turbid {
namespace {

/// Voxels along the edge of a leaf and of what a slot of the two kinds of inner nodes spans; slots along a node's edge.
constexpr int kLeafEdge = 8, kLowerSlots = 16, kLowerEdge = kLeafEdge * kLowerSlots, kUpperSlots = 32,
              kUpperEdge = kLowerEdge * kUpperSlots;
constexpr size_t cube(int n) { return static_cast<size_t>(n) * static_cast<size_t>(n) * static_cast<size_t>(n); }

/// Farthest index that sums of a few edges do not push out of an int.
constexpr int kFarthest = 1 << 30;

/// Trees keep z fastest, x slowest.
Voxel slot_of(const Voxel& origin, size_t slot, int slots, int edge) {
  const int n = static_cast<int>(slot);
  return {origin.x + n / (slots * slots) * edge, origin.y + n / slots % slots * edge, origin.z + n % slots * edge};
}

class TreeReader {
 public:
  TreeReader(ByteReader& file, VdbEncoding encoding) : file_(file), encoding_(std::move(encoding)) {}

  VdbVoxels read() {
    read_root();
    return fill();
  }

 private:
  struct Tile {
    Voxel origin;
    int edge;
    Spectrum value;
  };

  Spectrum spectrum(const float* values) const {
    if (encoding_.channels == 1) return Spectrum(values[0]);
    return {values[0], values[1], values[2]};
  }

  void read_root() {
    if (file_.read<int32_t>() != 1) file_.fail("trees with several buffers per leaf are not supported");
    encoding_.background = read_value();
    const auto tiles = file_.read<uint32_t>(), children = file_.read<uint32_t>();
    for (uint32_t i = 0; i < tiles; ++i) {
      const Voxel origin = read_origin();
      const std::vector<float> value = read_value();
      file_.read<uint8_t>();  // active or not, its value holds
      add_tile(origin, kUpperEdge, value.data());
    }
    for (uint32_t i = 0; i < children; ++i) {
      const Voxel origin = read_origin();
      read_inner(origin, kUpperSlots, kLowerEdge);
    }
  }

  std::vector<float> read_value() {
    std::vector<float> value(static_cast<size_t>(encoding_.channels));
    for (float& v : value) v = file_.read<float>();
    return value;
  }

  Voxel read_origin() {
    Voxel origin;
    for (int* v : {&origin.x, &origin.y, &origin.z}) {
      *v = file_.read<int32_t>();
      if (*v % kUpperEdge != 0 || *v < -kFarthest || *v > kFarthest)
        file_.fail(fmt::format("damaged: a node stands at {}", *v));
    }
    return origin;
  }

  /// An inner node with `slots` along its edge that span `edge` voxels each.
  void read_inner(const Voxel& origin, int slots, int edge) {
    const VdbMask children(file_, cube(slots)), active(file_, cube(slots));
    const std::vector<float> values = read_vdb_values(file_, encoding_, active);
    for (size_t i = 0; i < cube(slots); ++i)
      if (!children.on(i))
        add_tile(slot_of(origin, i, slots, edge), edge, &values[i * static_cast<size_t>(encoding_.channels)]);
    for (size_t i = 0; i < cube(slots); ++i) {
      if (!children.on(i)) continue;
      const Voxel place = slot_of(origin, i, slots, edge);
      if (edge == kLeafEdge) {
        leaves_.push_back(place);
        file_.take(cube(kLeafEdge) / 8);  // the mask stands once more before the values
      } else {
        read_inner(place, kLowerSlots, kLeafEdge);
      }
    }
  }

  void add_tile(const Voxel& origin, int edge, const float* value) {
    if (!(spectrum(value) == spectrum(encoding_.background.data()))) tiles_.push_back({origin, edge, spectrum(value)});
  }

  void include(const Voxel& origin, int edge) {
    first_ = {std::min(first_.x, origin.x), std::min(first_.y, origin.y), std::min(first_.z, origin.z)};
    end_ = {std::max(end_.x, origin.x + edge), std::max(end_.y, origin.y + edge), std::max(end_.z, origin.z + edge)};
  }

  VdbVoxels fill() {
    for (const Voxel& leaf : leaves_) include(leaf, kLeafEdge);
    for (const Tile& tile : tiles_) include(tile.origin, tile.edge);
    if (leaves_.empty() && tiles_.empty()) first_ = end_ = {0, 0, 0};
    const Voxel origin{first_.x - kLeafEdge, first_.y - kLeafEdge, first_.z - kLeafEdge};
    const Voxel size{end_.x + kLeafEdge - origin.x, end_.y + kLeafEdge - origin.y, end_.z + kLeafEdge - origin.z};
    try {
      GridVoxels voxels(size, encoding_.channels, encoding_.half ? VoxelFormat::kHalf : VoxelFormat::kFloat,
                        spectrum(encoding_.background.data()));
      const auto brick = [&](const Voxel& v) {
        return Voxel{(v.x - origin.x) / kLeafEdge, (v.y - origin.y) / kLeafEdge, (v.z - origin.z) / kLeafEdge};
      };
      for (const Tile& tile : tiles_) {
        const Voxel first = brick(tile.origin);
        const int count = tile.edge / kLeafEdge;
        for (int z = first.z; z < first.z + count; ++z)
          for (int y = first.y; y < first.y + count; ++y)
            for (int x = first.x; x < first.x + count; ++x) voxels.set_brick({x, y, z}, tile.value);
      }
      for (const Voxel& leaf : leaves_) voxels.set_brick(brick(leaf), read_leaf());
      return {std::move(voxels), origin};
    } catch (const std::invalid_argument& error) {
      file_.fail(error.what());
    }
  }

  /// The values of the next leaf, x fastest.
  std::vector<float> read_leaf() {
    const VdbMask active(file_, cube(kLeafEdge));
    const std::vector<float> values = read_vdb_values(file_, encoding_, active);
    const auto width = static_cast<size_t>(encoding_.channels);
    std::vector<float> turned(values.size());
    for (size_t i = 0; i < cube(kLeafEdge); ++i) {
      const size_t x = i / 64, y = i / 8 % 8, z = i % 8;
      for (size_t c = 0; c < width; ++c) turned[((z * 8 + y) * 8 + x) * width + c] = values[i * width + c];
    }
    return turned;
  }

  ByteReader& file_;
  VdbEncoding encoding_;
  std::vector<Voxel> leaves_;
  std::vector<Tile> tiles_;
  Voxel first_{kFarthest, kFarthest, kFarthest}, end_{-kFarthest, -kFarthest, -kFarthest};
};

}  // namespace

VdbVoxels read_vdb_tree(ByteReader& file, VdbEncoding encoding) { return TreeReader(file, std::move(encoding)).read(); }

}  // namespace turbid
