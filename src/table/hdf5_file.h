#pragma once
#include <hdf5.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "core/hash.h"

/// Files of tables by the HDF5 library: attributes and data sets of numbers, in memory.
namespace turbid::hdf5 {

/// What a call of the library refused to do, or what is wrong with a file.
struct Refused {
  const char* what;
};

template <class Id>
Id check(Id id, const char* what) {
  if (id < 0) throw Refused{what};
  return id;
}

/// An object of the library that closes itself.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t), const char* what) : id_(check(id, what)), close_(close) {}
  ~Handle() { close_(id_); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

template <class T>
hid_t type_of() {
  if constexpr (std::is_same_v<T, float>) return H5T_NATIVE_FLOAT;
  if constexpr (std::is_same_v<T, double>) return H5T_NATIVE_DOUBLE;
  if constexpr (std::is_same_v<T, int8_t>) return H5T_NATIVE_INT8;
  if constexpr (std::is_same_v<T, int>) return H5T_NATIVE_INT;
  if constexpr (std::is_same_v<T, uint64_t>) return H5T_NATIVE_UINT64;
}

template <class T>
void write_attribute(hid_t file, const char* name, const T& value) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose, "space");
  const Handle attribute(H5Acreate2(file, name, type_of<T>(), space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose, name);
  check(H5Awrite(attribute, type_of<T>(), &value), name);
}

template <class T>
T read_attribute(hid_t file, const char* name) {
  T value{};
  const Handle attribute(H5Aopen(file, name, H5P_DEFAULT), H5Aclose, name);
  check(H5Aread(attribute, type_of<T>(), &value), name);
  return value;
}

void write_numbers(hid_t file, const std::string& name, hid_t type, size_t size, const void* data, const char* meaning);
size_t count_numbers(hid_t file, const std::string& name);
void read_numbers(hid_t file, const std::string& name, hid_t type, void* data);
void make_group(hid_t file, const std::string& name);

/// A data set with a sentence about itself.
template <class T>
void write_data(hid_t file, const std::string& name, const std::vector<T>& data, const char* meaning) {
  write_numbers(file, name, type_of<T>(), data.size(), data.data(), meaning);
}

/// Of at most `most` numbers.
template <class T>
std::vector<T> read_data_up_to(hid_t file, const std::string& name, size_t most) {
  const size_t count = count_numbers(file, name);
  if (count > most) throw Refused{"a data set has not the size that it should have"};
  std::vector<T> data(count);
  if (count > 0) read_numbers(file, name, type_of<T>(), data.data());
  return data;
}

template <class T>
std::vector<T> read_data(hid_t file, const std::string& name, size_t expected) {
  std::vector<T> data = read_data_up_to<T>(file, name, expected);
  if (data.size() != expected) throw Refused{"a data set has not the size that it should have"};
  return data;
}

/// Continues a checksum.
template <class T>
uint64_t hash(const std::vector<T>& data, uint64_t start) {
  return hash_bytes({reinterpret_cast<const char*>(data.data()), data.size() * sizeof(T)}, start);
}

/// The bytes of a file of this format and version that `write` fills.
std::string encode(const char* format, int version, const std::function<void(hid_t)>& write);

/// Calls `read` with the file in these bytes. Throws FileError in the name of `path` when they are damaged, cut off, of
/// another version or format, or `read` throws Refused.
void open(std::span<const char> bytes, const std::string& path, const char* format, int version,
          const std::function<void(hid_t)>& read);

/// What `read` makes of the file in these bytes; see open().
template <class Read>
auto decode(std::span<const char> bytes, const std::string& path, const char* format, int version, const Read& read) {
  std::optional<decltype(read(hid_t{}))> result;
  open(bytes, path, format, version, [&](hid_t file) { result.emplace(read(file)); });
  return std::move(*result);
}

}  // namespace turbid::hdf5
