#include "scene/source_text.h"

#include <algorithm>

namespace turbid {

SourceText::SourceText(std::string file, std::string text) : file_(std::move(file)), text_(std::move(text)) {
  line_starts_.push_back(0);
  for (size_t i = 0; i < text_.size(); ++i)
    if (text_[i] == '\n') line_starts_.push_back(i + 1);
}

SourceLocation SourceText::locate(size_t offset) const {
  offset = std::min(offset, text_.size());
  const auto next = std::upper_bound(line_starts_.begin(), line_starts_.end(), offset);
  const size_t start = *(next - 1);
  // Bytes 10xxxxxx continue a character.
  const auto characters = std::count_if(text_.begin() + static_cast<std::ptrdiff_t>(start),
                                        text_.begin() + static_cast<std::ptrdiff_t>(offset),
                                        [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; });
  return {file_, static_cast<int>(next - line_starts_.begin()), static_cast<int>(characters) + 1};
}

SourceLocation SourceText::locate_attribute(size_t tag, const std::string& attribute) const {
  constexpr const char* kSpace = " \t\r\n";
  size_t at = text_.find_first_of(" \t\r\n/>", tag);
  while (at != std::string::npos) {
    at = text_.find_first_not_of(kSpace, at);
    if (at == std::string::npos || text_[at] == '>' || text_[at] == '/') break;
    const size_t name_end = text_.find_first_of(" \t\r\n=", at);
    const size_t open = text_.find_first_of("\"'", at);
    if (name_end == std::string::npos || open == std::string::npos) break;
    if (text_.compare(at, name_end - at, attribute) == 0) return locate(open + 1);
    const size_t close = text_.find(text_[open], open + 1);
    if (close == std::string::npos) break;
    at = close + 1;
  }
  return locate(tag > 0 ? tag - 1 : 0);
}

}  // namespace turbid
