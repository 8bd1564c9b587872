#pragma once
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string_view>
#include <vector>

struct z_stream_s;

namespace turbid {

/// Reads little-endian numbers from zlib-compressed bytes in memory. Memory grows with what really is there, not with
/// what a file claims. Throws FileError with the file's name when the data are damaged or end too early.
class Inflater {
 public:
  Inflater(const std::filesystem::path& path, std::string_view compressed);
  ~Inflater();
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  [[noreturn]] void fail(const std::string& message) const;

  template <class T>
  T read() {
    T value;
    read_bytes(&value, sizeof(T));
    return value;
  }

  template <class T>
  std::vector<T> read_array(uint64_t count) {
    constexpr uint64_t kStep = 1 << 16;
    std::vector<T> values;
    while (values.size() < count) {
      const size_t begin = values.size();
      values.resize(begin + static_cast<size_t>(std::min(kStep, count - begin)));
      read_bytes(values.data() + begin, (values.size() - begin) * sizeof(T));
    }
    return values;
  }

 private:
  void read_bytes(void* to, size_t count);

  const std::filesystem::path& path_;
  std::unique_ptr<z_stream_s> stream_;
};

}  // namespace turbid
