#pragma once
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace turbid {

/// Walks over a little-endian binary file in memory. Everything that would read past its end throws FileError "... ends
/// too early", so that a reader need not check.
class ByteReader {
 public:
  /// Reads the whole file. Throws FileError when that fails.
  explicit ByteReader(const std::string& path);

  const std::string& path() const { return path_; }
  size_t left() const { return bytes_.size() - at_; }
  /// Throws FileError with the file's name.
  [[noreturn]] void fail(const std::string& message) const;

  /// Goes to a place counted from the start.
  void seek(uint64_t offset);
  /// The next `count` bytes; they live as long as the reader.
  std::span<const char> take(size_t count);

  template <class T>
  T read() {
    static_assert(std::is_trivially_copyable_v<T>);
    T value;
    std::memcpy(&value, take(sizeof(T)).data(), sizeof(T));
    return value;
  }

 private:
  std::string path_;
  std::vector<char> bytes_;
  size_t at_ = 0;
};

}  // namespace turbid
