#include "geometry/inflater.h"

#include <zlib.h>

#include <limits>
#include <new>

#include "core/error.h"

namespace turbid {

Inflater::Inflater(const std::filesystem::path& path, std::string_view compressed)
    : path_(path), stream_(std::make_unique<z_stream_s>()) {
  // zlib counts in 32 bits: meshes of more than 4 GiB of compressed data are cut off there.
  compressed = compressed.substr(0, std::numeric_limits<uInt>::max());
  stream_->next_in = reinterpret_cast<Bytef*>(const_cast<char*>(compressed.data()));  // zlib only reads it
  stream_->avail_in = static_cast<uInt>(compressed.size());
  if (inflateInit(stream_.get()) != Z_OK) throw std::bad_alloc();
}

Inflater::~Inflater() { inflateEnd(stream_.get()); }

void Inflater::fail(const std::string& message) const { throw FileError(path_.string(), message); }

void Inflater::read_bytes(void* to, size_t count) {
  stream_->next_out = static_cast<Bytef*>(to);
  while (count > 0) {
    const auto step = static_cast<uInt>(std::min<size_t>(count, 1 << 30));
    stream_->avail_out = step;
    const int status = inflate(stream_.get(), Z_SYNC_FLUSH);
    count -= step - stream_->avail_out;
    if (count == 0) return;
    if (status == Z_MEM_ERROR) throw std::bad_alloc();
    if (status == Z_STREAM_END || status == Z_BUF_ERROR) fail("the mesh's data end too early");
    if (status != Z_OK) fail("the mesh's data are damaged: they cannot be decompressed");
  }
}

}  // namespace turbid
