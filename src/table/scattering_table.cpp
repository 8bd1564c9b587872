#include "table/scattering_table.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/gauss_legendre.h"
#include "core/parallel.h"
#include "table/far_field.h"

namespace turbid {
namespace {

constexpr size_t kOrders = SagittalHarmonics::kOrders;

/// sum albedo^(n-5) over a bin's orders, for what lies in one cell: the sum over the bin, shared out among the cells in
/// proportion to albedo^n of each cell's own mean order n.
class BinWeight {
 public:
  BinWeight(const OrderBin& bin, size_t kind, const TableShape& shape, double albedo)
      : mean_order_(bin.mean_order[kind]), middle_((bin.first + bin.last) / 2.0), tilt_(bin.count() > 1 && albedo > 0) {
    for (int n = bin.first; n <= bin.last; ++n) sum_ += n == 5 ? 1 : std::pow(albedo, n - 5);
    tilt_ = tilt_ && sum_ > 1e-30;
    if (!tilt_) return;
    logarithm_ = std::log(albedo);
    const size_t cells = shape.grid.cell_count();
    double inside = 0, shares = 0;
    for (size_t cell = 0; cell < cells; ++cell) {
      const double content =
          static_cast<double>(bin.moments[kind][cell * shape.cell_size()]) * std::sqrt(4 * std::numbers::pi);
      inside += content;
      if (content > 0) shares += content * share(cell);
    }
    if (inside < 1 - 1e-6) shares += (1 - inside) * share(cells);
    sum_ /= shares;
  }
  double operator()(size_t cell) const { return tilt_ ? sum_ * share(cell) : sum_; }

 private:
  double share(size_t cell) const {
    const double n = static_cast<double>(mean_order_[cell]);
    return n > 0 ? std::exp(logarithm_ * (n - middle_)) : 0;
  }

  const std::vector<float>& mean_order_;
  double middle_, logarithm_ = 0, sum_ = 0;
  bool tilt_;
};

/// int Y_lm dV of one set in every cell.
std::vector<float> gather_set(const std::vector<OrderBin>& bins, size_t kind, size_t set, const TableShape& shape) {
  const size_t cell_size = shape.cell_size();
  std::vector<float> contents(shape.grid.cell_count() * cell_size);
  for (const OrderBin& bin : bins) {
    if (set == ScatteringTable::kOrder3   ? bin.first != 3
        : set == ScatteringTable::kOrder4 ? bin.first != 4
                                          : bin.first < 5)
      continue;
    const BinWeight weight(bin, kind, shape, set < kAlbedoNodes ? albedo_at_node(static_cast<int>(set)) : 1);
    for (size_t cell = 0; cell < shape.grid.cell_count(); ++cell) {
      const double factor = weight(cell);
      if (factor < 1e-30) continue;
      const auto scale = static_cast<float>(factor);
      for (size_t i = cell * cell_size; i < (cell + 1) * cell_size; ++i) contents[i] += scale * bin.moments[kind][i];
    }
  }
  return contents;
}

/// r T_00 at the nodes from the contents of cells. Sharpening may overshoot where light falls off steeply within a
/// cell: those cells keep their plain mean, and what that changes in the whole is made good by one factor.
std::vector<float> node_densities(const std::vector<float>& contents, const TableShape& shape) {
  const size_t cell_size = shape.cell_size();
  std::vector<float> nodes(shape.grid.cell_count());
  double inside = 0;
  for (size_t cell = 0; cell < nodes.size(); ++cell) {
    nodes[cell] = contents[cell * cell_size];
    inside += static_cast<double>(nodes[cell]);
  }
  shape.grid.to_nodes(nodes);
  for (int i = 0; i < shape.grid.radii(); ++i)
    for (int j = 0; j < shape.grid.angles(); ++j) {
      const size_t cell = shape.grid.index(i, j);
      const float mean = contents[cell * cell_size] * static_cast<float>(shape.grid.mean_of_content(i, j));
      if (!(nodes[cell] > 0.3f * mean && nodes[cell] < 3 * mean)) nodes[cell] = mean;
    }
  const double whole = shape.grid.content(nodes);
  if (whole > 0)
    for (float& node : nodes) node *= static_cast<float>(inside / whole);
  return nodes;
}

/// What the far field makes of a ring of cells, over its value at the ring's middle: the mean of r T.
double mean_over_ring(const FarField& far, const PolarGrid& grid, int ring, float cosine) {
  const GaussLegendre rule(4);
  double sum = 0, mass = 0;
  for (size_t k = 0; k < rule.size(); ++k) {
    const double r = std::lerp(grid.radius(ring), grid.radius(ring + 1), rule.node(k)), weight = rule.weight(k) * r;
    sum +=
        weight * static_cast<double>(far.ratio(static_cast<float>(r), static_cast<float>(grid.middle(ring)), cosine));
    mass += weight;
  }
  return sum / mass;
}

/// What lies beyond the far field's edge is its continuation: samples are few there, and at low albedo only their
/// rarest count. It begins as what lies in the ring at the edge says: nodes there make the interpolant's content right,
/// which bends less than the light does, so they are up to 3 % too low for what is no interpolant. The lobes go on as
/// they are at the edge.
void continue_far(std::vector<float>& nodes, std::vector<float>& contents, const TableShape& shape,
                  const FarField& far) {
  const PolarGrid& grid = shape.grid;
  const int edge = far.edge(grid);
  const size_t cell_size = shape.cell_size();
  for (int j = 0; j < grid.angles(); ++j) {
    const auto cosine = static_cast<float>(grid.cosine(j + 0.5));
    const size_t first = grid.index(edge, j);
    const double mean = static_cast<double>(contents[first * cell_size]) * grid.mean_of_content(edge, j);
    nodes[first] = static_cast<float>(mean / mean_over_ring(far, grid, edge, cosine));
    for (int i = edge + 1; i < grid.radii(); ++i) {
      nodes[grid.index(i, j)] =
          nodes[first] * far.ratio(static_cast<float>(grid.middle(i)), static_cast<float>(grid.middle(edge)), cosine);
      std::copy_n(contents.begin() + static_cast<std::ptrdiff_t>(first * cell_size), cell_size,
                  contents.begin() + static_cast<std::ptrdiff_t>(grid.index(i, j) * cell_size));
    }
  }
}

ScatteringTable::Kind pack(const std::vector<OrderBin>& bins, size_t kind, const ScatteringTable& table) {
  const size_t cells = table.shape.grid.cell_count(), cell_size = table.shape.cell_size();
  const auto coefficients = table.coefficients();
  std::array<std::vector<float>, ScatteringTable::kSets> contents, nodes;
  parallel_for(ScatteringTable::kSets, [&](size_t set) {
    contents[set] = gather_set(bins, kind, set, table.shape);
    nodes[set] = node_densities(contents[set], table.shape);
    if (set < kAlbedoNodes)
      continue_far(nodes[set], contents[set], table.shape,
                   FarField(table.moments, albedo_at_node(static_cast<int>(set)), static_cast<SourceKind>(kind)));
  });
  // A cell's lobe is the mean of its light's: sharpened as well it would have more noise, and could leave its bounds.
  const auto ratio = [&](size_t set, size_t cell, size_t c) {
    const auto [l, m] = coefficients[c];
    const float* content = contents[set].data() + cell * cell_size;
    if (!(content[0] > 0)) return 0.0f;
    return content[static_cast<size_t>(l) * kOrders + static_cast<size_t>(m)] / content[0] *
           static_cast<float>(table.moments[static_cast<size_t>(l)]);
  };
  ScatteringTable::Kind result;
  result.density.resize(ScatteringTable::kSets * cells);
  result.largest.resize(coefficients.size());
  result.ratios.resize(ScatteringTable::kSets * cells * coefficients.size());
  for (size_t set = 0; set < ScatteringTable::kSets; ++set)
    for (size_t cell = 0; cell < cells; ++cell) {
      result.density[set * cells + cell] = nodes[set][cell];
      for (size_t c = 0; c < coefficients.size(); ++c)
        result.largest[c] = std::max(result.largest[c], std::abs(ratio(set, cell, c)));
    }
  for (size_t set = 0; set < ScatteringTable::kSets; ++set)
    for (size_t cell = 0; cell < cells; ++cell)
      for (size_t c = 0; c < coefficients.size(); ++c)
        result.ratios[(set * cells + cell) * coefficients.size() + c] =
            encode_ratio(ratio(set, cell, c), result.largest[c]);
  return result;
}

}  // namespace

double albedo_at_node(int node) {
  const double last = std::pow(1 - kLargestAlbedo, 0.25);
  return 1 - std::pow(1 + (last - 1) * node / (kAlbedoNodes - 1), 4);
}

std::vector<std::pair<int, int>> ScatteringTable::coefficients() const {
  std::vector<std::pair<int, int>> result;
  for (int l = 1; l <= shape.bands.degree; ++l)
    for (int m = 0; m <= std::min(l, shape.bands.order); ++m) result.emplace_back(l, m);
  return result;
}

size_t ScatteringTable::size() const {
  size_t bytes = moments.size() * sizeof(double);
  for (const Kind& kind : kinds)
    bytes += (kind.density.size() + kind.largest.size()) * sizeof(float) + kind.ratios.size();
  return bytes;
}

ScatteringTable build_table(const PhaseFunction& phase, const TableShape& shape, const SimulationSettings& settings) {
  ScatteringTable table{shape, legendre_moments(phase, 64), settings.seed, settings.deposits, {}};
  const std::vector<OrderBin> bins = simulate_orders(phase, shape, settings);
  for (size_t kind = 0; kind < kSourceKinds; ++kind) table.kinds[kind] = pack(bins, kind, table);
  return table;
}

}  // namespace turbid
