#include "geometry/text_cursor.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "core/error.h"

namespace turbid {

std::string read_whole_file(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) throw FileError(path.string(), "the file does not exist");
  if (std::filesystem::is_directory(path, error)) throw FileError(path.string(), "is a folder, not a file");
  const auto size = std::filesystem::file_size(path, error);
  std::ifstream file(path, std::ios::binary);
  if (error || !file) throw FileError(path.string(), std::string("cannot be opened: ") + std::strerror(errno));
  std::string bytes(size, '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(size));
  if (static_cast<uintmax_t>(file.gcount()) != size) throw FileError(path.string(), "cannot be read to its end");
  return bytes;
}

int TextCursor::line() const { return 1 + static_cast<int>(std::count(start_, at_, '\n')); }

void TextCursor::skip_blanks() {
  while (at_ != end_) {
    if (*at_ == ' ' || *at_ == '\t' || *at_ == '\r') {
      ++at_;
    } else if (*at_ == '\\' && at_ + 1 != end_ && at_[1] == '\n') {
      at_ += 2;
    } else if (*at_ == '\\' && end_ - at_ > 2 && at_[1] == '\r' && at_[2] == '\n') {
      at_ += 3;
    } else {
      return;
    }
  }
}

void TextCursor::skip_space() {
  while (at_ != end_ && (*at_ == ' ' || *at_ == '\t' || *at_ == '\r' || *at_ == '\n')) ++at_;
}

void TextCursor::next_line() {
  while (at_ != end_) {
    const auto* stop = static_cast<const char*>(std::memchr(at_, '\n', static_cast<size_t>(end_ - at_)));
    if (stop == nullptr) {
      at_ = end_;
      return;
    }
    const char* last = stop != at_ && stop[-1] == '\r' ? stop - 1 : stop;
    const bool joined = last != at_ && last[-1] == '\\';
    at_ = stop + 1;
    if (!joined) return;
  }
}

std::string_view TextCursor::word() {
  const char* from = at_;
  while (at_ != end_ && *at_ != ' ' && *at_ != '\t' && *at_ != '\r' && *at_ != '\n') ++at_;
  return {from, static_cast<size_t>(at_ - from)};
}

}  // namespace turbid
