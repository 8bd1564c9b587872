#include "geometry/ply_header.h"

#include <fmt/format.h>

#include <array>

#include "core/error.h"
#include "geometry/text_cursor.h"

namespace turbid {
namespace {
struct TypeName {
  std::string_view name;
  PlyType type;
};
constexpr std::array<TypeName, 16> kTypeNames{{{"char", PlyType::kInt8},
                                               {"int8", PlyType::kInt8},
                                               {"uchar", PlyType::kUInt8},
                                               {"uint8", PlyType::kUInt8},
                                               {"short", PlyType::kInt16},
                                               {"int16", PlyType::kInt16},
                                               {"ushort", PlyType::kUInt16},
                                               {"uint16", PlyType::kUInt16},
                                               {"int", PlyType::kInt32},
                                               {"int32", PlyType::kInt32},
                                               {"uint", PlyType::kUInt32},
                                               {"uint32", PlyType::kUInt32},
                                               {"float", PlyType::kFloat32},
                                               {"float32", PlyType::kFloat32},
                                               {"double", PlyType::kFloat64},
                                               {"float64", PlyType::kFloat64}}};

class HeaderParser {
 public:
  HeaderParser(const std::filesystem::path& path, std::string_view bytes) : path_(path), bytes_(bytes), at_(bytes) {}

  PlyHeader parse() {
    if (next_word() != "ply") throw FileError(path_.string(), "is not a PLY file: it does not begin with 'ply'");
    end_of_statement();
    bool has_format = false;
    while (true) {
      if (at_.at_end()) fail("the header ends without 'end_header'");
      const std::string_view keyword = next_word();
      if (keyword == "format") {
        format();
        has_format = true;
      } else if (keyword == "element") {
        element();
      } else if (keyword == "property") {
        property();
      } else if (keyword == "end_header") {
        break;
      } else if (keyword != "comment" && keyword != "obj_info" && !keyword.empty()) {
        fail(fmt::format("unknown header line '{}'", keyword));
      } else {
        at_.next_line();
        continue;
      }
      end_of_statement();
    }
    at_.next_line();
    if (!has_format) throw FileError(path_.string(), "the header has no 'format' line");
    header_.data_offset = at_.offset();
    check_claims();
    return std::move(header_);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw FileError(path_.string(), fmt::format("line {}: {}", at_.line(), message));
  }

  std::string_view next_word() {
    at_.skip_blanks();
    return at_.word();
  }

  void end_of_statement() {
    at_.skip_blanks();
    if (!at_.at_line_end()) fail(fmt::format("unexpected '{}' at the end of a header line", at_.word()));
    at_.next_line();
  }

  void format() {
    const std::string_view name = next_word();
    if (name == "ascii")
      header_.ascii = true;
    else if (name == "binary_big_endian")
      header_.big_endian = true;
    else if (name != "binary_little_endian")
      fail(fmt::format("unknown format '{}', expected ascii, binary_little_endian or binary_big_endian", name));
    const std::string_view version = next_word();
    if (version != "1.0") fail(fmt::format("unknown format version '{}', expected 1.0", version));
  }

  void element() {
    const std::string name(next_word());
    if (name.empty()) fail("an element needs a name");
    at_.skip_blanks();
    uint64_t count = 0;
    if (!at_.number(count)) fail(fmt::format("the number of '{}' elements is not a count: '{}'", name, at_.word()));
    header_.elements.push_back({name, count, {}});
  }

  PlyType type() {
    const std::string_view name = next_word();
    for (const TypeName& t : kTypeNames)
      if (t.name == name) return t.type;
    fail(fmt::format("unknown property type '{}'", name));
  }

  void property() {
    if (header_.elements.empty()) fail("a property before the first element");
    PlyProperty p{};
    TextCursor before = at_;
    if (next_word() == "list") {
      p.is_list = true;
      p.count_type = type();
      if (!ply_is_integer(p.count_type)) fail("the length of a list must have an integer type");
    } else {
      at_ = before;
    }
    p.type = type();
    p.name = next_word();
    if (p.name.empty()) fail("a property needs a name");
    header_.elements.back().properties.push_back(p);
  }

  /// Before anything is allocated: does the file hold what the header says?
  void check_claims() const {
    size_t left = bytes_.size() - header_.data_offset;
    for (const PlyElement& e : header_.elements) {
      const size_t least = e.least_size(header_.ascii);
      if (least == 0) continue;
      // The last value of an ascii file needs no separator.
      if (e.count > (left + 1) / least)
        throw FileError(path_.string(),
                        fmt::format("the header claims {} '{}' elements of at least {} bytes each, but only {} bytes "
                                    "of data are left in the file",
                                    e.count, e.name, least, left));
      left -= std::min(left, static_cast<size_t>(e.count) * least);
    }
  }

  const std::filesystem::path& path_;
  std::string_view bytes_;
  TextCursor at_;
  PlyHeader header_;
};
}  // namespace

size_t ply_size(PlyType type) {
  constexpr std::array<size_t, 8> kSizes{1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<size_t>(type)];
}

size_t PlyElement::least_size(bool ascii) const {
  if (ascii) return 2 * properties.size();  // a digit and a separator each
  size_t size = 0;
  for (const PlyProperty& p : properties) size += ply_size(p.is_list ? p.count_type : p.type);
  return size;
}

int PlyElement::find(std::string_view property) const {
  for (size_t i = 0; i < properties.size(); ++i)
    if (properties[i].name == property) return static_cast<int>(i);
  return -1;
}

PlyHeader parse_ply_header(const std::filesystem::path& path, std::string_view bytes) {
  return HeaderParser(path, bytes).parse();
}

}  // namespace turbid
