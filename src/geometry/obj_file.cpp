#include <fmt/format.h>

#include "core/error.h"
#include "geometry/mesh_file.h"
#include "geometry/text_cursor.h"

namespace turbid {
namespace {
constexpr uint32_t kNone = ~0u;

/// Reads the statements of one OBJ file. Corners name position, uv and normal apart; each different triple that occurs
/// becomes one vertex of the mesh.
class ObjReader {
 public:
  ObjReader(const std::filesystem::path& path, std::string_view text, bool flip_tex_coords)
      : path_(path), at_(text), flip_tex_coords_(flip_tex_coords) {}

  MeshData read() {
    for (; !at_.at_end(); at_.next_line()) {
      at_.skip_blanks();
      const char c = at_.peek();
      if (c != 'v' && c != 'f') continue;
      const std::string_view keyword = at_.word();
      if (keyword == "v")
        positions_.push_back(triple("vertex position"));
      else if (keyword == "vn")
        normals_.push_back(triple("vertex normal"));
      else if (keyword == "vt")
        uvs_.push_back(texture_coordinate());
      else if (keyword == "f")
        face();
    }
    if (mesh_.indices.empty()) throw FileError(path_.string(), "there are no faces ('f' lines)");
    if (!any_uv_) mesh_.uvs.clear();
    if (!any_normal_) mesh_.normals.clear();
    return std::move(mesh_);
  }

 private:
  struct Binding {
    uint32_t uv, normal, vertex, next;
  };

  [[noreturn]] void fail(const std::string& message) const {
    throw FileError(path_.string(), fmt::format("line {}: {}", at_.line(), message));
  }

  float coordinate(const char* what) {
    at_.skip_blanks();
    double value = 0;
    if (!at_.number(value)) fail(fmt::format("expected a number of a {}, found '{}'", what, at_.word()));
    const auto narrow = static_cast<float>(value);
    if (!std::isfinite(narrow)) fail(fmt::format("a {} is not finite", what));
    return narrow;
  }

  Vec3 triple(const char* what) {
    const float x = coordinate(what), y = coordinate(what);
    return {x, y, coordinate(what)};
  }

  Vec2 texture_coordinate() {
    const float u = coordinate("texture coordinate");
    at_.skip_blanks();
    const float v = at_.at_line_end() ? 0 : coordinate("texture coordinate");  // one-dimensional textures give u only
    return {u, flip_tex_coords_ ? 1 - v : v};
  }

  /// An index as the file counts: from 1, or from the end when negative.
  uint32_t reference(size_t count, const char* what) {
    int64_t index = 0;
    if (!at_.number(index)) fail(fmt::format("expected the index of a {}, found '{}'", what, at_.word()));
    const int64_t zero_based = index < 0 ? static_cast<int64_t>(count) + index : index - 1;
    if (index == 0 || zero_based < 0 || zero_based >= static_cast<int64_t>(count))
      fail(fmt::format("a face refers to {} {}, but there are {} so far", what, index, count));
    return static_cast<uint32_t>(zero_based);
  }

  uint32_t corner() {
    const uint32_t position = reference(positions_.size(), "vertex");
    uint32_t uv = kNone, normal = kNone;
    if (at_.peek() == '/') {
      at_.advance();
      if (at_.peek() != '/') uv = reference(uvs_.size(), "texture coordinate");
      if (at_.peek() == '/') {
        at_.advance();
        normal = reference(normals_.size(), "normal");
      }
    }
    if (first_binding_.size() < positions_.size()) first_binding_.resize(positions_.size(), kNone);
    uint32_t* link = &first_binding_[position];
    while (*link != kNone) {
      Binding& b = bindings_[*link];
      if (b.uv == uv && b.normal == normal) return b.vertex;
      link = &b.next;
    }
    const auto vertex = static_cast<uint32_t>(mesh_.positions.size());
    *link = static_cast<uint32_t>(bindings_.size());
    bindings_.push_back({uv, normal, vertex, kNone});
    any_uv_ |= uv != kNone;
    any_normal_ |= normal != kNone;
    mesh_.positions.push_back(positions_[position]);
    mesh_.uvs.push_back(uv == kNone ? Vec2(0.0f) : uvs_[uv]);
    mesh_.normals.push_back(normal == kNone ? Vec3(0.0f) : normals_[normal]);
    return vertex;
  }

  void face() {
    uint32_t first = 0, previous = 0;
    size_t corners = 0;
    for (at_.skip_blanks(); !at_.at_line_end() && at_.peek() != '#'; at_.skip_blanks()) {
      const uint32_t vertex = corner();
      if (!at_.at_end() && std::string_view(" \t\r\n\\").find(at_.peek()) == std::string_view::npos)
        fail(fmt::format("unexpected '{}' after a face corner", at_.word()));
      if (corners == 0) first = vertex;
      if (corners >= 2) mesh_.indices.insert(mesh_.indices.end(), {first, previous, vertex});
      previous = vertex;
      ++corners;
    }
    if (corners < 3) fail(fmt::format("a face needs at least 3 corners, found {}", corners));
  }

  const std::filesystem::path& path_;
  TextCursor at_;
  bool flip_tex_coords_;
  bool any_uv_ = false, any_normal_ = false;
  std::vector<Vec3> positions_, normals_;
  std::vector<Vec2> uvs_;
  std::vector<uint32_t> first_binding_;  ///< per position of the file, into bindings_
  std::vector<Binding> bindings_;
  MeshData mesh_;
};
}  // namespace

MeshData load_obj(const std::filesystem::path& path, const MeshFileOptions& options) {
  const std::string text = read_whole_file(path);
  MeshData mesh = ObjReader(path, text, options.flip_tex_coords).read();
  finish_loaded_mesh(mesh, path, options);
  return mesh;
}

}  // namespace turbid
