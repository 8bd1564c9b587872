#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstring>

#include "core/error.h"
#include "geometry/mesh_file.h"
#include "geometry/ply_header.h"
#include "geometry/text_cursor.h"

namespace turbid {
namespace {

/// Reads the values of a PLY file one after the other, whatever their encoding.
class PlyValues {
 public:
  PlyValues(const std::filesystem::path& path, std::string_view bytes, const PlyHeader& header)
      : path_(path),
        header_(header),
        text_(bytes),
        at_(bytes.data() + header.data_offset),
        end_(bytes.data() + bytes.size()) {
    text_.advance(header.data_offset);
  }

  /// Tells messages what is being read.
  void enter(const PlyElement& element, uint64_t index) {
    element_ = &element;
    index_ = index;
  }

  double next(PlyType type) {
    if (header_.ascii) return next_word(type);
    const size_t size = ply_size(type);
    if (static_cast<size_t>(end_ - at_) < size) fail("the file ends in the middle of");
    std::array<char, 8> bytes{};
    if (header_.big_endian)
      for (size_t i = 0; i < size; ++i) bytes[i] = at_[size - 1 - i];
    else
      std::memcpy(bytes.data(), at_, size);
    at_ += size;
    switch (type) {
      case PlyType::kInt8:
        return as<int8_t>(bytes);
      case PlyType::kUInt8:
        return as<uint8_t>(bytes);
      case PlyType::kInt16:
        return as<int16_t>(bytes);
      case PlyType::kUInt16:
        return as<uint16_t>(bytes);
      case PlyType::kInt32:
        return as<int32_t>(bytes);
      case PlyType::kUInt32:
        return as<uint32_t>(bytes);
      case PlyType::kFloat32:
        return as<float>(bytes);
      case PlyType::kFloat64:
        return as<double>(bytes);
    }
    return 0;
  }

  [[noreturn]] void fail(const std::string& message) const {
    throw FileError(path_.string(), fmt::format("{} {} {}", message, element_->name, index_));
  }

 private:
  static_assert(std::endian::native == std::endian::little);

  template <class T>
  static double as(const std::array<char, 8>& bytes) {
    T value;
    std::memcpy(&value, bytes.data(), sizeof value);
    return static_cast<double>(value);
  }

  double next_word(PlyType type) {
    text_.skip_space();
    if (text_.at_end()) fail("the file ends in the middle of");
    double value = 0;
    TextCursor before = text_;
    if (!text_.number(value) ||
        (!text_.at_end() && std::string_view(" \t\r\n").find(text_.peek()) == std::string_view::npos))
      fail(fmt::format("line {}: '{}' is not a number, in", before.line(), before.word()));
    if (ply_is_integer(type) && value != std::floor(value))
      fail(fmt::format("line {}: '{}' is not a whole number, in", before.line(), before.word()));
    return value;
  }

  const std::filesystem::path& path_;
  const PlyHeader& header_;
  const PlyElement* element_ = nullptr;
  uint64_t index_ = 0;
  TextCursor text_;
  const char *at_, *end_;
};

float srgb_to_linear(double v) {
  return static_cast<float>(v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4));  // IEC 61966-2-1
}

/// Where a scalar property of the file goes.
struct Target {
  enum class Kind : uint8_t { kIgnore, kPosition, kNormal, kUv, kAttribute } kind = Kind::kIgnore;
  size_t component = 0;
  size_t attribute = 0;  ///< which MeshAttribute
};

class PlyReader {
 public:
  PlyReader(const std::filesystem::path& path, std::string_view bytes, const MeshFileOptions& options)
      : path_(path), options_(options), header_(parse_ply_header(path, bytes)), values_(path, bytes, header_) {}

  MeshData read() {
    bool has_vertices = false, has_faces = false;
    for (const PlyElement& element : header_.elements) {
      if (element.name == "vertex") {
        read_vertices(element);
        has_vertices = true;
      } else if (element.name == "face") {
        read_faces(element);
        has_faces = true;
      } else {
        skip(element);
      }
    }
    if (!has_vertices) throw FileError(path_.string(), "there are no 'vertex' elements");
    if (!has_faces || mesh_.indices.empty()) throw FileError(path_.string(), "there are no faces");
    const size_t count = mesh_.positions.size();
    for (size_t i = 0; i < mesh_.indices.size(); ++i)
      if (mesh_.indices[i] >= count)
        throw FileError(path_.string(),
                        fmt::format("a face refers to vertex {}, but there are {}", mesh_.indices[i], count));
    return std::move(mesh_);
  }

 private:
  using Kind = Target::Kind;

  void skip_list(const PlyProperty& p) {
    const double count = list_length(p);
    for (double i = 0; i < count; ++i) values_.next(p.type);
  }
  double list_length(const PlyProperty& p) {
    const double count = values_.next(p.count_type);
    if (count < 0) values_.fail("a list of negative length in");
    return count;
  }

  void skip(const PlyElement& element) {
    if (element.properties.empty()) return;
    for (uint64_t i = 0; i < element.count; ++i) {
      values_.enter(element, i);
      for (const PlyProperty& p : element.properties)
        if (p.is_list)
          skip_list(p);
        else
          values_.next(p.type);
    }
  }

  static void assign(const PlyElement& element, std::vector<Target>& targets, std::initializer_list<const char*> names,
                     Kind kind) {
    size_t component = 0;
    for (const char* name : names) targets[static_cast<size_t>(element.find(name))] = {kind, component++, 0};
  }
  static bool has(const PlyElement& element, std::initializer_list<const char*> names) {
    for (const char* name : names) {
      const int i = element.find(name);
      if (i < 0 || element.properties[static_cast<size_t>(i)].is_list) return false;
    }
    return true;
  }

  /// What is left becomes attributes, grouped as Mitsuba 3 does: r g b (red green blue) make "color"; name_x name_y
  /// ..., name_r name_g ..., name_0 name_1 ..., name_1 name_2 ... make "name". Values beyond three channels are
  /// dropped.
  void add_attributes(const PlyElement& element, std::vector<Target>& targets, bool per_face) {
    static constexpr std::array<std::string_view, 5> kSuffixes{"rgba", "xyzw", "0123", "1234", ""};
    const std::string prefix = per_face ? "face_" : "vertex_";
    const size_t first = mesh_.attributes.size();
    for (size_t i = 0; i < targets.size(); ++i) {
      const PlyProperty& p = element.properties[i];
      if (p.is_list || targets[i].kind != Kind::kIgnore) continue;
      std::string name = p.name;
      size_t component = 0;
      bool grouped = false;
      if (name == "red" || name == "green" || name == "blue" || name == "alpha") name = name.substr(0, 1);
      if (name.size() == 1 && kSuffixes[0].find(name) != std::string_view::npos) {
        component = kSuffixes[0].find(name);
        name = "color";
        grouped = true;
      } else if (name.size() > 2 && name[name.size() - 2] == '_') {
        for (const std::string_view suffixes : kSuffixes) {
          component = suffixes.find(name.back());
          if (component == std::string_view::npos) continue;
          // name_1 is the second of 0123 only after a name_0.
          if (suffixes == "0123" && component > 0 && element.find(name.substr(0, name.size() - 1) + "0") < 0) continue;
          grouped = true;
          break;
        }
        if (grouped) name.resize(name.size() - 2);
      }
      if (!grouped) component = 0;
      if (component > 2) continue;
      size_t a = first;
      while (a < mesh_.attributes.size() && mesh_.attributes[a].name != prefix + name) ++a;
      if (a == mesh_.attributes.size()) mesh_.attributes.push_back({prefix + name, 1, per_face, {}});
      if (component > 0) mesh_.attributes[a].channels = 3;
      targets[i] = {Kind::kAttribute, component, a};
    }
  }

  float attribute_value(PlyType type, double value) const {
    // Mitsuba 3 takes integers as sRGB-encoded fractions of their largest value.
    switch (type) {
      case PlyType::kUInt8:
        return srgb_to_linear(value / 255);
      case PlyType::kUInt16:
        return srgb_to_linear(value / 65535);
      default:
        return static_cast<float>(value);
    }
  }

  void read_vertices(const PlyElement& element) {
    if (!has(element, {"x", "y", "z"})) throw FileError(path_.string(), "the vertices have no x, y, z");
    std::vector<Target> targets(element.properties.size());
    assign(element, targets, {"x", "y", "z"}, Kind::kPosition);
    const auto count = static_cast<size_t>(element.count);
    mesh_.positions.reserve(count + 1);  // one more for a reader of whole registers
    mesh_.positions.resize(count);
    if (has(element, {"nx", "ny", "nz"})) {
      assign(element, targets, {"nx", "ny", "nz"}, Kind::kNormal);
      mesh_.normals.resize(count);
    }
    for (const auto& names : {std::array{"u", "v"}, std::array{"texture_u", "texture_v"}, std::array{"s", "t"}})
      if (mesh_.uvs.empty() && has(element, {names[0], names[1]})) {
        assign(element, targets, {names[0], names[1]}, Kind::kUv);
        mesh_.uvs.resize(count);
      }
    add_attributes(element, targets, false);
    for (MeshAttribute& a : mesh_.attributes)
      if (!a.per_face) a.values.assign(count * static_cast<size_t>(a.channels), 0.0f);

    for (size_t v = 0; v < count; ++v) {
      values_.enter(element, v);
      for (size_t i = 0; i < targets.size(); ++i) {
        const PlyProperty& p = element.properties[i];
        if (p.is_list) {
          skip_list(p);
          continue;
        }
        const double value = values_.next(p.type);
        const auto narrow = static_cast<float>(value);
        const auto component = static_cast<int>(targets[i].component);
        switch (targets[i].kind) {
          case Kind::kIgnore:
            break;
          case Kind::kPosition:
            if (!std::isfinite(narrow)) values_.fail(fmt::format("{} is not finite, in", p.name));
            mesh_.positions[v][component] = narrow;
            break;
          case Kind::kNormal:
            mesh_.normals[v][component] = narrow;
            break;
          case Kind::kUv:
            mesh_.uvs[v][component] = component == 1 && options_.flip_tex_coords ? 1 - narrow : narrow;
            break;
          case Kind::kAttribute: {
            MeshAttribute& a = mesh_.attributes[targets[i].attribute];
            a.values[v * static_cast<size_t>(a.channels) + targets[i].component] = attribute_value(p.type, value);
            break;
          }
        }
      }
    }
  }

  void read_faces(const PlyElement& element) {
    int list = element.find("vertex_indices");
    if (list < 0) list = element.find("vertex_index");
    if (list < 0 || !element.properties[static_cast<size_t>(list)].is_list)
      throw FileError(path_.string(), "the faces have no list 'vertex_indices' or 'vertex_index'");
    std::vector<Target> targets(element.properties.size());
    const size_t first_attribute = mesh_.attributes.size();
    add_attributes(element, targets, true);
    std::vector<std::array<float, 3>> face_values(mesh_.attributes.size());
    mesh_.indices.reserve(3 * static_cast<size_t>(element.count));

    for (uint64_t f = 0; f < element.count; ++f) {
      values_.enter(element, f);
      size_t triangles = 0;
      for (size_t i = 0; i < targets.size(); ++i) {
        const PlyProperty& p = element.properties[i];
        if (static_cast<int>(i) == list) {
          triangles = read_corners(p);
        } else if (p.is_list) {
          skip_list(p);
        } else {
          const double value = values_.next(p.type);
          if (targets[i].kind == Kind::kAttribute)
            face_values[targets[i].attribute][targets[i].component] = attribute_value(p.type, value);
        }
      }
      for (size_t a = first_attribute; a < mesh_.attributes.size(); ++a)
        for (size_t t = 0; t < triangles; ++t)
          mesh_.attributes[a].values.insert(mesh_.attributes[a].values.end(), face_values[a].begin(),
                                            face_values[a].begin() + mesh_.attributes[a].channels);
    }
  }

  uint32_t corner(const PlyProperty& p) {
    const double index = values_.next(p.type);
    if (!(index >= 0 && index < 4294967295.0))
      values_.fail(fmt::format("the vertex index {} is out of range, in", index));
    return static_cast<uint32_t>(index);
  }

  /// The corners of a face as a fan of triangles; returns how many.
  size_t read_corners(const PlyProperty& p) {
    const double count = list_length(p);
    if (count < 3) values_.fail(fmt::format("fewer than 3 corners ({}) in", count));
    const uint32_t first = corner(p);
    uint32_t previous = corner(p);
    for (double i = 2; i < count; ++i) {
      const uint32_t next = corner(p);
      mesh_.indices.insert(mesh_.indices.end(), {first, previous, next});
      previous = next;
    }
    return static_cast<size_t>(count) - 2;
  }

  const std::filesystem::path& path_;
  const MeshFileOptions& options_;
  PlyHeader header_;
  PlyValues values_;
  MeshData mesh_;
};
}  // namespace

MeshData load_ply(const std::filesystem::path& path, const MeshFileOptions& options) {
  const std::string bytes = read_whole_file(path);
  MeshData mesh = PlyReader(path, bytes, options).read();
  finish_loaded_mesh(mesh, path, options);
  return mesh;
}

}  // namespace turbid
