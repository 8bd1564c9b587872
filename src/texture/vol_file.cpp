#include "texture/vol_file.h"

#include <fmt/format.h>

#include <stdexcept>

#include "texture/byte_reader.h"

namespace turbid {
namespace {

enum Encoding : int32_t { kFloat32 = 1, kFloat16 = 2, kUint8 = 3 };

size_t bytes_per_value(const ByteReader& file, int32_t encoding) {
  switch (encoding) {
    case kFloat32:
      return 4;
    case kFloat16:
      return 2;
    case kUint8:
      return 1;
    default:
      file.fail(fmt::format("encoding {} is not supported: 1 (float32), 2 (float16) and 3 (uint8) are", encoding));
  }
}

template <class T, class Convert>
std::vector<float> read_values(ByteReader& file, size_t count, const Convert& convert) {
  std::vector<T> stored(count);
  std::memcpy(stored.data(), file.take(count * sizeof(T)).data(), count * sizeof(T));
  std::vector<float> values(count);
  for (size_t i = 0; i < count; ++i) values[i] = convert(stored[i]);
  return values;
}

}  // namespace

VolFile read_vol(const std::string& path) {
  ByteReader file(path);
  if (file.left() < 4 || std::memcmp(file.take(3).data(), "VOL", 3) != 0)
    file.fail("not a Mitsuba grid: such files begin with 'VOL'");
  if (const auto version = file.read<uint8_t>(); version != 3)
    file.fail(fmt::format("version {} of the grid format is not supported: only 3 is", version));
  const auto encoding = file.read<int32_t>();
  const size_t value_size = bytes_per_value(file, encoding);
  Voxel size;
  for (int* n : {&size.x, &size.y, &size.z}) {
    *n = file.read<int32_t>();
    if (*n < 1) file.fail(fmt::format("the grid has {} cells along an axis", *n));
  }
  const auto channels = file.read<int32_t>();
  if (channels != 1 && channels != 3)
    file.fail(fmt::format("grids with {} channels are not supported: only 1 and 3 are", channels));
  Vec3 low, high;
  for (Vec3* corner : {&low, &high})
    for (int axis = 0; axis < 3; ++axis) (*corner)[static_cast<unsigned>(axis)] = file.read<float>();

  // Dividing what there is cannot overflow, as multiplying what is claimed could.
  size_t cells = file.left() / value_size / static_cast<size_t>(channels);
  for (const int n : {size.x, size.y, size.z}) cells /= static_cast<size_t>(n);
  if (cells == 0)
    file.fail(fmt::format("the file ends too early for {} x {} x {} cells with {} channel(s)", size.x, size.y, size.z,
                          channels));
  const size_t count = static_cast<size_t>(size.x) * static_cast<size_t>(size.y) * static_cast<size_t>(size.z) *
                       static_cast<size_t>(channels);
  std::vector<float> values;
  if (encoding == kFloat32) {
    values = read_values<float>(file, count, [](float v) { return v; });
  } else if (encoding == kFloat16) {
    values = read_values<uint16_t>(file, count, [](uint16_t bits) {
      Imath::half h;
      h.setBits(bits);
      return static_cast<float>(h);
    });
  } else {
    values = read_values<uint8_t>(file, count, [](uint8_t v) { return static_cast<float>(v) / 255; });
  }
  try {
    const VoxelFormat format = encoding == kFloat16 ? VoxelFormat::kHalf : VoxelFormat::kFloat;
    return {GridVoxels::from_dense(size, channels, format, values), {low, high}};
  } catch (const std::invalid_argument& error) {
    file.fail(error.what());
  }
}

}  // namespace turbid
