#include "texture/byte_reader.h"

#include <bit>
#include <fstream>
#include <limits>

#include "core/error.h"

namespace turbid {

static_assert(std::endian::native == std::endian::little, "numbers are copied from files as they stand");

ByteReader::ByteReader(const std::string& path) : path_(path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const std::streamoff size = file ? static_cast<std::streamoff>(file.tellg()) : -1;
  if (size < 0 || size == std::numeric_limits<std::streamoff>::max()) fail("cannot be opened");
  bytes_.resize(static_cast<size_t>(size));
  file.seekg(0);
  if (size > 0 && !file.read(bytes_.data(), size)) fail("cannot be read");
}

void ByteReader::fail(const std::string& message) const { throw FileError(path_, message); }

void ByteReader::seek(uint64_t offset) {
  if (offset > bytes_.size()) fail("the file ends too early");
  at_ = static_cast<size_t>(offset);
}

std::span<const char> ByteReader::take(size_t count) {
  if (count > left()) fail("the file ends too early");
  const std::span<const char> result(bytes_.data() + at_, count);
  at_ += count;
  return result;
}

}  // namespace turbid
