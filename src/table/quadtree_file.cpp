#include "table/quadtree_file.h"

#include <stdexcept>

#include "table/hdf5_file.h"

namespace turbid {
namespace {

constexpr const char* kFormat = "turbid multiple scattering quadtree";
constexpr std::array kKindNames = {"collision", "segment"};
constexpr size_t kMostNodes = 1 << 20;

std::vector<float> values_of(const Spectrum& spectrum) {
  std::vector<float> values;
  for (int c = 0; c < kChannels; ++c) values.push_back(spectrum[c]);
  return values;
}

uint64_t checksum(const QuadtreeTable& table) {
  uint64_t h =
      hash_counters(table.settings.seed, table.settings.photons, static_cast<uint64_t>(table.settings.from_order));
  h = hdf5::hash(table.moments, hdf5::hash(values_of(table.albedo), h));
  for (const QuadtreeTable::Kind& kind : table.kinds)
    h = hdf5::hash(kind.factors,
                   hdf5::hash(kind.lobes, hdf5::hash(kind.tree.nodes(),
                                                     hash_counters(h, std::bit_cast<uint32_t>(kind.tree.reach())))));
  return h;
}

void write(hid_t file, const QuadtreeTable& table) {
  hdf5::write_attribute(file, "reach", table.kinds[0].tree.reach());
  hdf5::write_attribute(file, "seed", table.settings.seed);
  hdf5::write_attribute(file, "photons", uint64_t{table.settings.photons});
  hdf5::write_attribute(file, "from_order", table.settings.from_order);
  hdf5::write_attribute(file, "checksum", checksum(table));
  hdf5::write_data(file, "moments", table.moments, "Legendre moments of the phase function");
  hdf5::write_data(file, "albedo", values_of(table.albedo), "of each channel");
  for (size_t k = 0; k < kSourceKinds; ++k) {
    const std::string group = kKindNames[k];
    hdf5::make_group(file, group);
    hdf5::write_data(file, group + "/nodes", table.kinds[k].tree.nodes(),
                     "[node] first of four children, or -1 - leaf; roots first, half the reach wide");
    hdf5::write_data(file, group + "/lobes", table.kinds[k].lobes,
                     k == 0 ? "[leaf] angle of the axis, 18 samples of each channel"
                            : "[leaf] angle of the axis, 18 samples of each channel, 18 ratios of the other side, 18 "
                              "of the coronal section");
    hdf5::write_data(file, group + "/factors", table.kinds[k].factors,
                     "[leaf][channel] of the interpolant within the leaf");
  }
}

QuadtreeTable read(hid_t file) {
  const auto reach = hdf5::read_attribute<float>(file, "reach");
  const std::vector<float> albedo = hdf5::read_data<float>(file, "albedo", kChannels);
  const auto kind = [&](size_t k) {
    const std::string group = kKindNames[k];
    try {
      Quadtree tree(reach, hdf5::read_data_up_to<int>(file, group + "/nodes", kMostNodes));
      const size_t size = tree.leaf_count() * SampledLobe::size(k == static_cast<size_t>(SourceKind::kRay));
      const size_t factors = tree.leaf_count() * kChannels;
      return QuadtreeTable::Kind{std::move(tree), hdf5::read_data<float>(file, group + "/lobes", size),
                                 hdf5::read_data<float>(file, group + "/factors", factors)};
    } catch (const std::invalid_argument&) {
      throw hdf5::Refused{"its cells are no quadtree"};
    }
  };
  QuadtreeTable table{hdf5::read_data<double>(file, "moments", 65),
                      Spectrum(albedo[0], albedo[1], albedo[2]),
                      {hdf5::read_attribute<uint64_t>(file, "seed"), hdf5::read_attribute<uint64_t>(file, "photons"),
                       hdf5::read_attribute<int>(file, "from_order")},
                      {kind(0), kind(1)}};
  if (hdf5::read_attribute<uint64_t>(file, "checksum") != checksum(table)) throw hdf5::Refused{"its checksum is wrong"};
  return table;
}

}  // namespace

std::string encode_quadtree(const QuadtreeTable& table) {
  return hdf5::encode(kFormat, kQuadtreeVersion, [&](hid_t file) { write(file, table); });
}

QuadtreeTable decode_quadtree(std::span<const char> bytes, const std::string& path) {
  return hdf5::decode(bytes, path, kFormat, kQuadtreeVersion, read);
}

}  // namespace turbid
