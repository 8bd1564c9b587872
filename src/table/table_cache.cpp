#include "table/table_cache.h"

#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <mutex>

#include "core/cache_folder.h"
#include "core/error.h"
#include "core/hash.h"
#include "core/log.h"
#include "image/atomic_file.h"
#include "table/quadtree_file.h"
#include "table/table_file.h"

namespace turbid {
namespace {

std::string folder_for(const std::string& wanted) {
  return wanted.empty() ? cache_folder("tables", "TURBID_TABLES") : wanted;
}

/// What is asked for in full.
struct Order {
  std::vector<double> moments;
  TableShape shape;
  SimulationSettings settings;
  std::string path;

  Order(const PhaseFunction& phase, const TableRequest& request)
      : moments(legendre_moments(phase, 64)), settings(request.settings) {
    shape.bands = choose_bands(phase);
    if (settings.deposits == 0) settings.deposits = default_deposits(shape.bands);
    // Rounded, so that the last digits of other processors do not count.
    uint64_t key = hash_counters(kTableVersion, settings.seed, settings.deposits,
                                 static_cast<uint64_t>(shape.grid.radii()), static_cast<uint64_t>(shape.grid.angles()));
    for (const double moment : moments) key = hash_counters(key, static_cast<uint64_t>(std::llround(moment * 1e6)));
    path = fmt::format("{}/g{:.3f}-{:016x}.h5", folder_for(request.folder), moments[1], key);
  }

  bool matches(const ScatteringTable& table) const {
    return table.shape.bands == shape.bands && table.shape.grid.cell_count() == shape.grid.cell_count() &&
           table.seed == settings.seed && table.deposits == settings.deposits;
  }
};

/// What is asked of mode `seed`.
struct QuadtreeOrder {
  std::vector<double> moments;
  Spectrum albedo;
  QuadtreeSettings settings;
  std::string path;

  QuadtreeOrder(const PhaseFunction& phase, const Spectrum& wanted_albedo, const QuadtreeSettings& wanted,
                const std::string& folder)
      : moments(legendre_moments(phase, 64)), albedo(wanted_albedo), settings(wanted) {
    uint64_t key =
        hash_counters(kQuadtreeVersion, settings.seed, settings.photons, static_cast<uint64_t>(settings.from_order));
    for (const double moment : moments) key = hash_counters(key, static_cast<uint64_t>(std::llround(moment * 1e6)));
    for (int c = 0; c < kChannels; ++c) key = hash_counters(key, std::bit_cast<uint32_t>(albedo[c]));
    path = fmt::format("{}/seed-g{:.3f}-{:016x}.h5", folder_for(folder), moments[1], key);
  }

  bool matches(const QuadtreeTable& table) const {
    return table.albedo == albedo && table.settings.seed == settings.seed &&
           table.settings.photons == settings.photons && table.settings.from_order == settings.from_order;
  }
};

/// From the file; null when there is none that serves.
template <class Table, class Order, class Decode>
std::shared_ptr<const Table> load(const Order& order, const Decode& decode) {
  std::error_code ignored;
  if (!std::filesystem::exists(order.path, ignored)) return nullptr;
  try {
    auto table = std::make_shared<Table>(decode(read_file(order.path), order.path));
    if (order.matches(*table)) return table;
    log_warning(order.path + ": this table was made for something else; it is built anew");
  } catch (const FileError& error) {
    log_warning(std::string(error.what()) + "; it is built anew");
  }
  return nullptr;
}

void keep(const std::string& bytes, const std::string& path) {
  try {
    std::error_code error;
    std::filesystem::create_directories(std::filesystem::path(path).parent_path(), error);
    write_file_atomically(path, bytes);
  } catch (const FileError& error) {
    log_warning(std::string("a table of multiple scattering could not be kept: ") + error.what());
  }
}

/// One that is in use, from its file, or built and kept.
template <class Table, class Order, class Decode, class Build, class Encode>
std::shared_ptr<const Table> find(const Order& order, const Decode& decode, const Build& build, const Encode& encode) {
  static std::mutex mutex;
  static std::map<std::string, std::weak_ptr<const Table>> in_use;
  const std::lock_guard lock(mutex);
  std::weak_ptr<const Table>& kept = in_use[order.path];
  if (auto table = kept.lock()) return table;
  std::shared_ptr<const Table> table = load<Table>(order, decode);
  if (!table) {
    table = std::make_shared<Table>(build());
    keep(encode(*table), order.path);
  }
  kept = table;
  return table;
}

}  // namespace

size_t default_deposits(const BandLimits& bands) {
  return bands.degree == 0 ? 1'000'000 : bands.degree < 8 ? 1'500'000 : 2'000'000;
}

std::string table_path(const PhaseFunction& phase, const TableRequest& request) { return Order(phase, request).path; }

std::shared_ptr<const ScatteringTable> find_table(const PhaseFunction& phase, const TableRequest& request) {
  const Order order(phase, request);
  return find<ScatteringTable>(
      order, decode_table, [&] { return build_table(phase, order.shape, order.settings); }, encode_table);
}

std::string quadtree_path(const PhaseFunction& phase, const Spectrum& albedo, const QuadtreeSettings& settings,
                          const std::string& folder) {
  return QuadtreeOrder(phase, albedo, settings, folder).path;
}

std::shared_ptr<const QuadtreeTable> find_quadtree(const PhaseFunction& phase, const Spectrum& albedo,
                                                   const QuadtreeSettings& settings, const std::string& folder) {
  const QuadtreeOrder order(phase, albedo, settings, folder);
  return find<QuadtreeTable>(
      order, decode_quadtree, [&] { return build_quadtree_table(phase, albedo, settings); }, encode_quadtree);
}

}  // namespace turbid
