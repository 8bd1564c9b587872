#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "core/error.h"

namespace turbid {

/// The text of a scene file, to turn byte offsets into places for messages.
class SourceText {
 public:
  SourceText(std::string file, std::string text);

  const std::string& file() const { return file_; }
  const std::string& text() const { return text_; }

  /// Line and column of a byte offset, both from 1; columns count characters of UTF-8, not bytes.
  SourceLocation locate(size_t offset) const;

  /// Where the value of an attribute begins, in the tag whose name starts at `tag`; the tag itself when the attribute
  /// is not written there.
  SourceLocation locate_attribute(size_t tag, const std::string& attribute) const;

 private:
  std::string file_, text_;
  std::vector<size_t> line_starts_;
};

}  // namespace turbid
