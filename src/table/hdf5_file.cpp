#include "table/hdf5_file.h"

#include <hdf5_hl.h>

#include <mutex>
#include <stdexcept>

#include "core/error.h"

namespace turbid::hdf5 {
namespace {

/// The library is not made for several threads at once, and prints its errors unless told not to.
class Library {
 public:
  Library() : lock_(mutex()) { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

 private:
  static std::mutex& mutex() {
    static std::mutex instance;
    return instance;
  }
  std::lock_guard<std::mutex> lock_;
};

/// A file in memory: begun empty, or opened from bytes.
hid_t memory_file(std::span<const char> bytes) {
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "access");
  check(H5Pset_fapl_core(access, 1 << 20, false), "memory");
  if (bytes.empty()) {
    const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose, "creation");
    return H5Fcreate("table", H5F_ACC_TRUNC, creation, access);
  }
  // The library reads the image only, in spite of its signature.
  check(H5Pset_file_image(access, const_cast<char*>(bytes.data()), bytes.size()), "image");
  return H5Fopen("table", H5F_ACC_RDONLY, access);
}

/// Whether the file says that it is of this format.
bool has_format(hid_t file, const char* format) {
  if (H5Aexists(file, "format") <= 0 || H5Aexists(file, "version") <= 0) return false;
  const Handle attribute(H5Aopen(file, "format", H5P_DEFAULT), H5Aclose, "format");
  const Handle type(H5Aget_type(attribute), H5Tclose, "format");
  if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) > 0) return false;
  std::string text(H5Tget_size(type), '\0');
  check(H5Aread(attribute, type, text.data()), "format");
  return text.c_str() == std::string(format);
}

}  // namespace

void write_numbers(hid_t file, const std::string& name, hid_t type, size_t size, const void* data,
                   const char* meaning) {
  const hsize_t count = size;
  const Handle space(H5Screate_simple(1, &count, nullptr), H5Sclose, "space");
  const Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "properties");
  check(H5Pset_obj_track_times(properties, false), "times");
  if (size > 0) {
    check(H5Pset_chunk(properties, 1, &count), "chunk");
    check(H5Pset_shuffle(properties), "shuffle");
    check(H5Pset_deflate(properties, 6), "deflate");
  }
  const Handle set(H5Dcreate2(file, name.c_str(), type, space, H5P_DEFAULT, properties, H5P_DEFAULT), H5Dclose,
                   "data set");
  if (size > 0) check(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data), "data");
  check(H5LTset_attribute_string(file, name.c_str(), "meaning", meaning), "meaning");
}

size_t count_numbers(hid_t file, const std::string& name) {
  const Handle set(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose, "data set");
  const Handle space(H5Dget_space(set), H5Sclose, "space");
  return static_cast<size_t>(check(H5Sget_simple_extent_npoints(space), "data set"));
}

void read_numbers(hid_t file, const std::string& name, hid_t type, void* data) {
  const Handle set(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose, "data set");
  check(H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data), "data");
}

void make_group(hid_t file, const std::string& name) {
  const Handle handle(H5Gcreate2(file, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose, "group");
}

std::string encode(const char* format, int version, const std::function<void(hid_t)>& write) {
  const Library library;
  try {
    const Handle file(memory_file({}), H5Fclose, "file");
    check(H5LTset_attribute_string(file, "/", "format", format), "format");
    write_attribute(file, "version", version);
    write(file);
    check(H5Fflush(file, H5F_SCOPE_LOCAL), "flush");
    std::string bytes(static_cast<size_t>(check(H5Fget_file_image(file, nullptr, 0), "size")), '\0');
    check(H5Fget_file_image(file, bytes.data(), bytes.size()), "image");
    return bytes;
  } catch (const Refused& refused) {
    throw std::runtime_error(std::string("HDF5 cannot write a table: ") + refused.what);
  }
}

void open(std::span<const char> bytes, const std::string& path, const char* format, int version,
          const std::function<void(hid_t)>& read) {
  const Library library;
  try {
    if (bytes.empty()) throw Refused{"it is empty"};
    const Handle file(memory_file(bytes), H5Fclose, "it is no HDF5 file, or a damaged one");
    if (!has_format(file, format)) throw Refused{"it is no table"};
    if (read_attribute<int>(file, "version") != version) throw Refused{"it is of another version"};
    read(file);
  } catch (const Refused& refused) {
    throw FileError(path, std::string("this is not a usable table of multiple scattering: ") + refused.what);
  }
}

}  // namespace turbid::hdf5
