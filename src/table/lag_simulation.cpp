#include "table/lag_simulation.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "table/endless_walk.h"
#include "table/sagittal_view.h"

namespace turbid {
namespace {

/// Collects samples of one kind of source. They wait until there are many, and are then put in cell by cell: so that
/// the cell stays at hand, and several at once.
class Collector {
 public:
  Collector(const TableShape& shape, int degree) : shape_(shape), degree_(degree), cell_size_(shape.cell_size()) {
    moments_.resize(shape.grid.cell_count() * cell_size_);
    orders_.resize(shape.grid.cell_count() + 1);
    counts_.resize(shape.grid.cell_count() + 1);
    first_.resize(shape.grid.cell_count() + 1);
  }

  /// x: from the source to the last collision; axis: of the source; w: the direction into the last collision.
  void add(const Vec3Lanes& x, const Vec3Lanes& axis, const Vec3Lanes& w, const std::array<int, kLanes>& orders) {
    if (waiting_ + kLanes > kMost) put_in();
    const PolarGrid& grid = shape_.grid;
    const SagittalViewLanes view(x, axis, w);
    const LaneRow radial = to_row(grid.radial(view.distance)), angular = to_row(grid.angular(view.cosine));
    const LaneRow across = to_row(view.direction.x), off = to_row(view.direction.y), along = to_row(view.direction.z);
    for (size_t lane = 0; lane < kLanes; ++lane) {
      const int i = static_cast<int>(radial[lane]), j = std::min(static_cast<int>(angular[lane]), grid.angles() - 1);
      const bool inside = i < grid.radii();
      const size_t cell = inside ? grid.index(i, j) : grid.cell_count();
      orders_[cell] += orders[lane];
      counts_[cell] += 1;
      if (inside) samples_[waiting_++] = {{across[lane], off[lane], along[lane]}, static_cast<uint32_t>(cell)};
    }
  }

  void finish(size_t samples, std::vector<float>& moments, std::vector<float>& mean_order) {
    put_in();
    for (float& sum : moments_) sum /= static_cast<float>(samples);
    mean_order.resize(counts_.size());
    for (size_t c = 0; c < counts_.size(); ++c)
      mean_order[c] = counts_[c] > 0 ? static_cast<float>(orders_[c] / counts_[c]) : 0;
    moments = std::move(moments_);
  }

 private:
  void put_in() {
    // Sorts by counting.
    std::fill(first_.begin(), first_.end(), 0);
    for (size_t i = 0; i < waiting_; ++i) ++first_[samples_[i].cell + 1];
    for (size_t cell = 1; cell < first_.size(); ++cell) first_[cell] += first_[cell - 1];
    for (size_t i = 0; i < waiting_; ++i) sorted_[first_[samples_[i].cell]++] = samples_[i].direction;
    // Each cell now begins where the one before it ends.
    size_t begin = 0;
    for (size_t cell = 0; begin < waiting_; ++cell) {
      const size_t end = first_[cell];
      SagittalHarmonics::add_to(moments_.data() + cell * cell_size_, degree_, {sorted_.data() + begin, end - begin});
      begin = end;
    }
    waiting_ = 0;
  }

  struct Sample {
    Vec3 direction;
    uint32_t cell;
  };
  static constexpr size_t kMost = 16384;

  const TableShape& shape_;
  int degree_;
  size_t cell_size_;
  std::vector<float> moments_;
  std::vector<double> orders_, counts_;
  std::vector<Sample> samples_ = std::vector<Sample>(kMost);
  std::vector<Vec3> sorted_ = std::vector<Vec3>(kMost);
  std::vector<size_t> first_;  ///< where a cell's begin among the sorted ones
  size_t waiting_ = 0;
};

/// The bands that light of an order has. The more it has scattered the smoother its lobes: with s = n (1 - f), f the
/// largest moment beyond f_0, the bands above 1 + 20/s hold less than 0.3 % of the light (measured at g = 0.9: 21 at n
/// = 10, 5 at n = 44, 2 from n = 176 on), and samples would fill them with noise.
int degree_of_order(int order, const std::vector<double>& moments, int degree) {
  double largest = 0;
  for (size_t l = 1; l < moments.size(); ++l) largest = std::max(largest, std::abs(moments[l]));
  return std::min(degree, 1 + static_cast<int>(std::ceil(20 / (order * (1 - largest)))));
}

/// How the orders of a bin are sampled: by pairs of one walk each, or, those far apart, joined from pieces of all of
/// them. What limits the noise of these is how far the walks went.
struct Plan {
  bool joined;
  size_t stride, reach;
  double share;  ///< of the samples that the settings say

  explicit Plan(const OrderBin& bin) {
    const auto last = static_cast<size_t>(bin.last);
    joined = bin.first > 64;
    stride = joined ? 4 : 1;
    // The first orders are all that there is at low albedo; at high albedo many bins share the light.
    share = bin.first <= 6 ? 2 : bin.first <= 128 ? 1 : bin.first <= 1024 ? 0.5 : 0.25;
    reach = joined ? std::max<size_t>(1000, 2 * last / EndlessWalks::kCount) : last;
  }
};

void simulate_bin(const PhaseFunction& phase, const TableShape& shape, const SimulationSettings& settings, int degree,
                  OrderBin& bin) {
  const Plan plan(bin);
  constexpr size_t kWalks = EndlessWalks::kCount;
  EndlessWalks walks(phase, plan.reach, hash_counters(settings.seed, static_cast<uint64_t>(bin.first)));
  Collector collision(shape, degree), ray(shape, degree);
  const size_t rounds =
      (static_cast<size_t>(plan.share * static_cast<double>(settings.deposits)) + kWalks - 1) / kWalks;
  std::array<int, kWalks> orders;
  EndlessWalks::Flights flights;
  for (size_t n = 0; n < rounds; ++n) {
    for (size_t s = plan.stride; s > 0; --s) walks.step();
    for (size_t w = 0; w < kWalks; ++w) {
      const auto count = static_cast<uint64_t>(bin.count());
      orders[w] = bin.first + static_cast<int>(uint64_t{walks.rng(w).next_u32()} * count >> 32);
      // Order n is n - 1 flights after the first collision.
      flights[w] = static_cast<size_t>(orders[w] - 1);
    }
    const EndlessWalks::Passages p = plan.joined ? walks.joined(flights) : walks.latest(flights);
    collision.add(p.displacement, p.axis, p.last_direction, orders);
    ray.add(p.ray + p.displacement, p.axis, p.last_direction, orders);
  }
  const auto kind = [](SourceKind k) { return static_cast<size_t>(k); };
  collision.finish(rounds * kWalks, bin.moments[kind(SourceKind::kCollision)],
                   bin.mean_order[kind(SourceKind::kCollision)]);
  ray.finish(rounds * kWalks, bin.moments[kind(SourceKind::kRay)], bin.mean_order[kind(SourceKind::kRay)]);
}

}  // namespace

std::vector<std::pair<int, int>> order_bins() {
  std::vector<std::pair<int, int>> bins;
  for (int n = 3; n <= 10; ++n) bins.emplace_back(n, n);
  int first = 11;
  for (int half_octave = 1; half_octave <= 22; ++half_octave) {
    const int next = static_cast<int>(std::lround(11 * std::exp2(half_octave / 2.0)));
    bins.emplace_back(first, next - 1);
    first = next;
  }
  return bins;
}

std::vector<OrderBin> simulate_orders(const PhaseFunction& phase, const TableShape& shape,
                                      const SimulationSettings& settings) {
  std::vector<OrderBin> bins;
  for (const auto& [first, last] : order_bins()) bins.push_back({first, last, {}, {}});
  const std::vector<double> moments = legendre_moments(phase, std::max(1, shape.bands.degree));
  parallel_for(bins.size(), [&](size_t b) {
    simulate_bin(phase, shape, settings, degree_of_order(bins[b].first, moments, shape.bands.degree), bins[b]);
  });
  return bins;
}

}  // namespace turbid
