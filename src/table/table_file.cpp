#include "table/table_file.h"

#include "table/hdf5_file.h"

namespace turbid {
namespace {

constexpr const char* kFormat = "turbid multiple scattering table";
constexpr std::array kKindNames = {"collision", "ray"};

uint64_t checksum(const ScatteringTable& table) {
  const TableShape& shape = table.shape;
  uint64_t h = hash_counters(static_cast<uint64_t>(shape.grid.radii()), static_cast<uint64_t>(shape.grid.angles()),
                             std::bit_cast<uint64_t>(shape.grid.outer()), static_cast<uint64_t>(shape.bands.degree),
                             static_cast<uint64_t>(shape.bands.order), table.seed, table.deposits);
  h = hdf5::hash(table.moments, h);
  for (const ScatteringTable::Kind& kind : table.kinds)
    h = hdf5::hash(kind.ratios, hdf5::hash(kind.largest, hdf5::hash(kind.density, h)));
  return h;
}

void write_table(hid_t file, const ScatteringTable& table) {
  hdf5::write_attribute(file, "radii", table.shape.grid.radii());
  hdf5::write_attribute(file, "angles", table.shape.grid.angles());
  hdf5::write_attribute(file, "outer_radius", table.shape.grid.outer());
  hdf5::write_attribute(file, "largest_degree", table.shape.bands.degree);
  hdf5::write_attribute(file, "largest_order", table.shape.bands.order);
  hdf5::write_attribute(file, "seed", table.seed);
  hdf5::write_attribute(file, "samples_per_bin", table.deposits);
  hdf5::write_attribute(file, "checksum", checksum(table));
  hdf5::write_data(file, "moments", table.moments, "Legendre moments of the phase function");
  for (size_t k = 0; k < kSourceKinds; ++k) {
    const std::string group = kKindNames[k];
    hdf5::make_group(file, group);
    const ScatteringTable::Kind& kind = table.kinds[k];
    hdf5::write_data(
        file, group + "/density", kind.density,
        "[set][radius][angle] r T_00 in mean free paths; sets: nodes of albedo (orders 5 and more), order 3, 4");
    hdf5::write_data(file, group + "/largest", kind.largest, "[coefficient (l, m), l >= 1] largest ratio");
    hdf5::write_data(file, group + "/ratios", kind.ratios,
                     "[set][radius][angle][coefficient] T_lm / T_00 = q |q| / 127^2 of the largest");
  }
}

ScatteringTable read_table(hid_t file) {
  const int radii = hdf5::read_attribute<int>(file, "radii"), angles = hdf5::read_attribute<int>(file, "angles");
  const double outer = hdf5::read_attribute<double>(file, "outer_radius");
  const BandLimits bands{hdf5::read_attribute<int>(file, "largest_degree"),
                         hdf5::read_attribute<int>(file, "largest_order")};
  if (radii < 4 || radii > 1024 || angles < 4 || angles > 1024 || !(outer > 1 && outer < 1e6) || bands.degree < 0 ||
      bands.degree > SagittalHarmonics::kMaxDegree || bands.order < 0 || bands.order >= SagittalHarmonics::kOrders)
    throw hdf5::Refused{"its shape is out of range"};
  ScatteringTable table{{PolarGrid(radii, angles, outer), bands},
                        hdf5::read_data<double>(file, "moments", 65),
                        hdf5::read_attribute<uint64_t>(file, "seed"),
                        hdf5::read_attribute<uint64_t>(file, "samples_per_bin"),
                        {}};
  const size_t cells = ScatteringTable::kSets * table.shape.grid.cell_count(), rows = table.coefficients().size();
  for (size_t k = 0; k < kSourceKinds; ++k) {
    const std::string group = kKindNames[k];
    table.kinds[k].density = hdf5::read_data<float>(file, group + "/density", cells);
    table.kinds[k].largest = hdf5::read_data<float>(file, group + "/largest", rows);
    table.kinds[k].ratios = hdf5::read_data<int8_t>(file, group + "/ratios", cells * rows);
  }
  if (hdf5::read_attribute<uint64_t>(file, "checksum") != checksum(table)) throw hdf5::Refused{"its checksum is wrong"};
  return table;
}

}  // namespace

std::string encode_table(const ScatteringTable& table) {
  return hdf5::encode(kFormat, kTableVersion, [&](hid_t file) { write_table(file, table); });
}

ScatteringTable decode_table(std::span<const char> bytes, const std::string& path) {
  return hdf5::decode(bytes, path, kFormat, kTableVersion, read_table);
}

}  // namespace turbid
