#include "table/lag_simulation.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "table/endless_walk.h"
#include "table/sagittal_view.h"

namespace turbid {
namespace {

/// Collects samples of one kind of source.
class Collector {
 public:
  Collector(const TableShape& shape, int degree) : shape_(shape), degree_(degree), cell_size_(shape.cell_size()) {
    moments_.resize(shape.grid.cell_count() * cell_size_);
    orders_.resize(shape.grid.cell_count() + 1);
    counts_.resize(shape.grid.cell_count() + 1);
  }

  /// x: from the source to the last collision; axis: of the source; w: the direction into the last collision.
  void add(const Vec3& x, const Vec3& axis, const Vec3& w, int order) {
    const SagittalView view(x, axis, w);
    const int i = static_cast<int>(shape_.grid.radial(view.distance));
    const int j = std::min(static_cast<int>(shape_.grid.angular(view.cosine)), shape_.grid.angles() - 1);
    const bool inside = i < shape_.grid.radii();
    const size_t cell = inside ? shape_.grid.index(i, j) : shape_.grid.cell_count();
    orders_[cell] += order;
    counts_[cell] += 1;
    if (!inside) return;
    float* sums = moments_.data() + cell * cell_size_;
    SagittalHarmonics::for_each_degree(degree_, view.direction, [&](int, const SagittalHarmonics::Lanes& y) {
      (SagittalHarmonics::load(sums) + y).copy_to(sums, std::experimental::element_aligned);
      sums += SagittalHarmonics::kOrders;
    });
  }

  void finish(size_t samples, std::vector<float>& moments, std::vector<float>& mean_order) {
    for (float& sum : moments_) sum /= static_cast<float>(samples);
    mean_order.resize(counts_.size());
    for (size_t c = 0; c < counts_.size(); ++c)
      mean_order[c] = counts_[c] > 0 ? static_cast<float>(orders_[c] / counts_[c]) : 0;
    moments = std::move(moments_);
  }

 private:
  const TableShape& shape_;
  int degree_;
  size_t cell_size_;
  std::vector<float> moments_;
  std::vector<double> orders_, counts_;
};

/// The bands that light of an order has. The more it has scattered the smoother its lobes: with s = n (1 - f), f the
/// largest moment beyond f_0, the bands above 1 + 20/s hold less than 0.3 % of the light (measured at g = 0.9: 21 at n
/// = 10, 5 at n = 44, 2 from n = 176 on), and samples would fill them with noise.
int degree_of_order(int order, const std::vector<double>& moments, int degree) {
  double largest = 0;
  for (size_t l = 1; l < moments.size(); ++l) largest = std::max(largest, std::abs(moments[l]));
  return std::min(degree, 1 + static_cast<int>(std::ceil(20 / (order * (1 - largest)))));
}

/// Independent walks side by side: each waits for its own last step alone.
constexpr size_t kWalks = 8;

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
    reach = joined ? std::max<size_t>(1000, 2 * last / kWalks) : last;
  }
};

void simulate_bin(const PhaseFunction& phase, const TableShape& shape, const SimulationSettings& settings, int degree,
                  OrderBin& bin) {
  const Plan plan(bin);
  std::vector<EndlessWalk> walks;
  for (size_t w = 0; w < kWalks; ++w)
    walks.emplace_back(phase, plan.reach, hash_counters(settings.seed, static_cast<uint64_t>(bin.first), w));
  Collector collision(shape, degree), ray(shape, degree);
  const size_t rounds =
      (static_cast<size_t>(plan.share * static_cast<double>(settings.deposits)) + kWalks - 1) / kWalks;
  for (size_t n = 0; n < rounds; ++n) {
    for (size_t s = plan.stride; s > 0; --s)
      for (EndlessWalk& walk : walks) walk.step();
    for (EndlessWalk& walk : walks) {
      const auto orders = static_cast<uint64_t>(bin.count());
      const int order = bin.first + static_cast<int>(uint64_t{walk.rng().next_u32()} * orders >> 32);
      // Order n is n - 1 flights after the first collision.
      const auto flights = static_cast<size_t>(order - 1);
      const EndlessWalk::Passage p = plan.joined ? join_passages(walks, flights) : walk.latest(flights);
      collision.add(p.displacement, p.axis, p.last_direction, order);
      ray.add(p.ray + p.displacement, p.axis, p.last_direction, order);
    }
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
