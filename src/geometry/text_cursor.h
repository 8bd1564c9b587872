#pragma once
#include <charconv>
#include <filesystem>
#include <string>
#include <string_view>

namespace turbid {

/// The whole file as bytes. Throws FileError when it cannot be read.
std::string read_whole_file(const std::filesystem::path& path);

/// Walks over text in memory, for readers of large files.
class TextCursor {
 public:
  explicit TextCursor(std::string_view text) : start_(text.data()), at_(start_), end_(start_ + text.size()) {}

  bool at_end() const { return at_ == end_; }
  bool at_line_end() const { return at_ == end_ || *at_ == '\n'; }
  char peek() const { return at_ == end_ ? '\0' : *at_; }
  std::string_view rest() const { return {at_, static_cast<size_t>(end_ - at_)}; }
  size_t offset() const { return static_cast<size_t>(at_ - start_); }
  /// Line of the position, from 1. Counts from the start: for messages only.
  int line() const;

  void advance(size_t n = 1) { at_ += n; }
  /// Skips blanks within the line; a backslash at the end of a line joins it with the next.
  void skip_blanks();
  /// Skips blanks and ends of lines.
  void skip_space();
  /// Goes to the beginning of the next line; honours joined lines.
  void next_line();
  /// The characters up to the next blank or end of line.
  std::string_view word();

  /// Reads a number of the type at the position, with an optional '+'; false, without moving, when there is none or it
  /// does not fit.
  template <class Number>
  bool number(Number& value) {
    const char* from = at_ != end_ && *at_ == '+' ? at_ + 1 : at_;
    const auto [stop, error] = std::from_chars(from, end_, value);
    if (error != std::errc{}) return false;
    at_ = stop;
    return true;
  }

 private:
  const char *start_, *at_, *end_;
};

}  // namespace turbid
