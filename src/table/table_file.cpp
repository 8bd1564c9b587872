#include "table/table_file.h"

#include <hdf5.h>
#include <hdf5_hl.h>

#include <mutex>

#include "core/error.h"
#include "core/hash.h"

namespace turbid {
namespace {

constexpr const char* kFormat = "turbid multiple scattering table";
constexpr std::array kKindNames = {"collision", "ray"};

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

/// What a call of the library refused to do.
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

/// A data set with a sentence about itself.
template <class T>
void write_data(hid_t file, const std::string& name, const std::vector<T>& data, const char* meaning) {
  const hsize_t size = data.size();
  const Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose, "space");
  const Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "properties");
  check(H5Pset_obj_track_times(properties, false), "times");
  if (size > 0) {
    check(H5Pset_chunk(properties, 1, &size), "chunk");
    check(H5Pset_shuffle(properties), "shuffle");
    check(H5Pset_deflate(properties, 6), "deflate");
  }
  const Handle set(H5Dcreate2(file, name.c_str(), type_of<T>(), space, H5P_DEFAULT, properties, H5P_DEFAULT), H5Dclose,
                   "data set");
  if (size > 0) check(H5Dwrite(set, type_of<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, data.data()), "data");
  check(H5LTset_attribute_string(file, name.c_str(), "meaning", meaning), "meaning");
}

template <class T>
std::vector<T> read_data(hid_t file, const std::string& name, size_t expected) {
  const Handle set(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose, "data set");
  const Handle space(H5Dget_space(set), H5Sclose, "space");
  const hssize_t size = H5Sget_simple_extent_npoints(space);
  if (size < 0 || static_cast<size_t>(size) != expected)
    throw Refused{"a data set has not the size that it should have"};
  std::vector<T> data(expected);
  if (size > 0) check(H5Dread(set, type_of<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, data.data()), "data");
  return data;
}

template <class T>
uint64_t hash(const std::vector<T>& data, uint64_t start) {
  return hash_bytes({reinterpret_cast<const char*>(data.data()), data.size() * sizeof(T)}, start);
}

uint64_t checksum(const ScatteringTable& table) {
  const TableShape& shape = table.shape;
  uint64_t h = hash_counters(static_cast<uint64_t>(shape.grid.radii()), static_cast<uint64_t>(shape.grid.angles()),
                             std::bit_cast<uint64_t>(shape.grid.outer()), static_cast<uint64_t>(shape.bands.degree),
                             static_cast<uint64_t>(shape.bands.order), table.seed, table.deposits);
  h = hash(table.moments, h);
  for (const ScatteringTable::Kind& kind : table.kinds)
    h = hash(kind.ratios, hash(kind.largest, hash(kind.density, h)));
  return h;
}

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

void write_table(hid_t file, const ScatteringTable& table) {
  check(H5LTset_attribute_string(file, "/", "format", kFormat), "format");
  write_attribute(file, "version", kTableVersion);
  write_attribute(file, "radii", table.shape.grid.radii());
  write_attribute(file, "angles", table.shape.grid.angles());
  write_attribute(file, "outer_radius", table.shape.grid.outer());
  write_attribute(file, "largest_degree", table.shape.bands.degree);
  write_attribute(file, "largest_order", table.shape.bands.order);
  write_attribute(file, "seed", table.seed);
  write_attribute(file, "samples_per_bin", table.deposits);
  write_attribute(file, "checksum", checksum(table));
  write_data(file, "moments", table.moments, "Legendre moments of the phase function");
  for (size_t k = 0; k < kSourceKinds; ++k) {
    const std::string group = kKindNames[k];
    const Handle handle(H5Gcreate2(file, group.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose, "group");
    const ScatteringTable::Kind& kind = table.kinds[k];
    write_data(file, group + "/density", kind.density,
               "[set][radius][angle] r T_00 in mean free paths; sets: nodes of albedo (orders 5 and more), order 3, 4");
    write_data(file, group + "/largest", kind.largest, "[coefficient (l, m), l >= 1] largest ratio");
    write_data(file, group + "/ratios", kind.ratios,
               "[set][radius][angle][coefficient] T_lm / T_00 = q |q| / 127^2 of the largest");
  }
}

ScatteringTable read_table(hid_t file) {
  if (H5Aexists(file, "format") <= 0 || H5Aexists(file, "version") <= 0) throw Refused{"it is no table"};
  if (read_attribute<int>(file, "version") != kTableVersion) throw Refused{"it is of another version"};
  const int radii = read_attribute<int>(file, "radii"), angles = read_attribute<int>(file, "angles");
  const double outer = read_attribute<double>(file, "outer_radius");
  const BandLimits bands{read_attribute<int>(file, "largest_degree"), read_attribute<int>(file, "largest_order")};
  if (radii < 4 || radii > 1024 || angles < 4 || angles > 1024 || !(outer > 1 && outer < 1e6) || bands.degree < 0 ||
      bands.degree > SagittalHarmonics::kMaxDegree || bands.order < 0 || bands.order >= SagittalHarmonics::kOrders)
    throw Refused{"its shape is out of range"};
  ScatteringTable table{{PolarGrid(radii, angles, outer), bands},
                        read_data<double>(file, "moments", 65),
                        read_attribute<uint64_t>(file, "seed"),
                        read_attribute<uint64_t>(file, "samples_per_bin"),
                        {}};
  const size_t cells = ScatteringTable::kSets * table.shape.grid.cell_count(), rows = table.coefficients().size();
  for (size_t k = 0; k < kSourceKinds; ++k) {
    const std::string group = kKindNames[k];
    table.kinds[k].density = read_data<float>(file, group + "/density", cells);
    table.kinds[k].largest = read_data<float>(file, group + "/largest", rows);
    table.kinds[k].ratios = read_data<int8_t>(file, group + "/ratios", cells * rows);
  }
  if (read_attribute<uint64_t>(file, "checksum") != checksum(table)) throw Refused{"its checksum is wrong"};
  return table;
}

}  // namespace

std::string encode_table(const ScatteringTable& table) {
  const Library library;
  try {
    const Handle file(memory_file({}), H5Fclose, "file");
    write_table(file, table);
    check(H5Fflush(file, H5F_SCOPE_LOCAL), "flush");
    std::string bytes(static_cast<size_t>(check(H5Fget_file_image(file, nullptr, 0), "size")), '\0');
    check(H5Fget_file_image(file, bytes.data(), bytes.size()), "image");
    return bytes;
  } catch (const Refused& refused) {
    throw std::runtime_error(std::string("HDF5 cannot write a table: ") + refused.what);
  }
}

ScatteringTable decode_table(std::span<const char> bytes, const std::string& path) {
  const Library library;
  try {
    if (bytes.empty()) throw Refused{"it is empty"};
    const Handle file(memory_file(bytes), H5Fclose, "it is no HDF5 file, or a damaged one");
    return read_table(file);
  } catch (const Refused& refused) {
    throw FileError(path, std::string("this is not a usable table of multiple scattering: ") + refused.what);
  }
}

}  // namespace turbid
