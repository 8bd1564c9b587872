#include <fmt/format.h>

#include <bit>
#include <cmath>

#include "core/error.h"
#include "geometry/inflater.h"
#include "geometry/mesh_file.h"
#include "geometry/text_cursor.h"

namespace turbid {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are copied from files as they stand");

constexpr uint16_t kFormat = 0x041c;
constexpr size_t kHeaderSize = 2 * sizeof(uint16_t);
enum Flag : uint32_t {
  kNormals = 0x1,
  kUvs = 0x2,
  kColors = 0x8,
  kFaceNormals = 0x10,
  kDouble = 0x2000,
};

/// The file as bytes; places are checked.
class SerializedFile {
 public:
  explicit SerializedFile(const std::filesystem::path& path) : path_(path), bytes_(read_whole_file(path)) {
    if (bytes_.size() < kHeaderSize || at<uint16_t>(0) != kFormat)
      fail("not a serialized mesh: it does not begin with 0x041C");
    version_ = at<uint16_t>(sizeof(uint16_t));
    if (version_ != 3 && version_ != 4)
      fail(fmt::format("version {} of serialized meshes is not supported: 3 and 4 are", version_));
  }

  int version() const { return version_; }

  /// What is compressed of a mesh, and all that follows it.
  std::string_view content(int64_t index) const {
    const uint64_t begin = index == 0 ? 0 : place_of(index);
    if (begin > bytes_.size() || bytes_.size() - begin < kHeaderSize)
      fail(fmt::format("mesh {} stands beyond the end of the file", index));
    return std::string_view(bytes_).substr(static_cast<size_t>(begin) + kHeaderSize);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const { throw FileError(path_.string(), message); }

  template <class T>
  T at(size_t offset) const {
    T value;
    std::memcpy(&value, bytes_.data() + offset, sizeof(T));
    return value;
  }

  /// From the table at the end: a place per mesh, then their number.
  uint64_t place_of(int64_t index) const {
    if (bytes_.size() < kHeaderSize + sizeof(uint32_t)) fail("the file ends too early");
    const size_t end = bytes_.size() - sizeof(uint32_t);
    const auto count = at<uint32_t>(end);
    if (index < 0 || index >= count) fail(fmt::format("there is no mesh {}: there are {}, from 0", index, count));
    const size_t entry = version_ == 4 ? sizeof(uint64_t) : sizeof(uint32_t),
                 back = entry * (count - static_cast<size_t>(index));
    if (back > end - kHeaderSize) fail(fmt::format("the file claims {} meshes and is too short for that", count));
    return version_ == 4 ? at<uint64_t>(end - back) : at<uint32_t>(end - back);
  }

  const std::filesystem::path& path_;
  std::string bytes_;
  int version_ = 0;
};

/// `count` tuples of N numbers in the file's precision.
template <size_t N>
std::vector<float> read_numbers(Inflater& data, uint64_t count, bool is_double) {
  if (!is_double) return data.read_array<float>(N * count);
  const std::vector<double> values = data.read_array<double>(N * count);
  std::vector<float> result(values.size());
  for (size_t i = 0; i < values.size(); ++i) result[i] = static_cast<float>(values[i]);
  return result;
}

template <class V, size_t N>
std::vector<V> read_vectors(Inflater& data, uint64_t count, bool is_double) {
  const std::vector<float> numbers = read_numbers<N>(data, count, is_double);
  std::vector<V> vectors(numbers.size() / N);
  for (size_t i = 0; i < vectors.size(); ++i)
    for (size_t k = 0; k < N; ++k) vectors[i][static_cast<int>(k)] = numbers[N * i + k];
  return vectors;
}

void skip_name(Inflater& data) {
  constexpr int kLongest = 1 << 16;
  for (int i = 0; data.read<char>() != '\0'; ++i)
    if (i == kLongest) data.fail("the mesh's name has no end");
}

}  // namespace

MeshData load_serialized(const std::filesystem::path& path, int64_t shape_index, const MeshFileOptions& options) {
  const SerializedFile file(path);
  Inflater data(path, file.content(shape_index));
  const auto flags = data.read<uint32_t>();
  if (file.version() == 4) skip_name(data);
  const auto vertices = data.read<uint64_t>(), triangles = data.read<uint64_t>();
  constexpr uint64_t kMost = uint64_t{1} << 31;
  if (vertices >= kMost || triangles >= kMost)
    data.fail(
        fmt::format("{} vertices and {} triangles are claimed: a mesh can have up to 2^31 - 1", vertices, triangles));

  const bool is_double = flags & kDouble;
  MeshData mesh;
  mesh.positions = read_vectors<Vec3, 3>(data, vertices, is_double);
  for (const Vec3& p : mesh.positions)
    if (!std::isfinite(p.x + p.y + p.z)) data.fail("a vertex position is not finite");
  if (flags & kNormals) mesh.normals = read_vectors<Vec3, 3>(data, vertices, is_double);
  if (flags & kUvs) mesh.uvs = read_vectors<Vec2, 2>(data, vertices, is_double);
  if (flags & kColors)
    mesh.attributes.push_back(
        {.name = "vertex_color", .channels = 3, .values = read_numbers<3>(data, vertices, is_double)});
  mesh.indices = data.read_array<uint32_t>(3 * triangles);
  for (const uint32_t i : mesh.indices)
    if (i >= vertices) data.fail(fmt::format("a triangle refers to vertex {}, but there are {}", i, vertices));

  MeshFileOptions wanted = options;
  wanted.face_normals = options.face_normals || (flags & kFaceNormals);
  finish_loaded_mesh(mesh, path, wanted);
  if (shape_index > 0) mesh.name += fmt::format("@{}", shape_index);
  return mesh;
}

}  // namespace turbid
