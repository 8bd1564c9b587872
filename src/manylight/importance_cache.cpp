#include "manylight/importance_cache.h"

#include <numeric>

#include "core/parallel.h"

namespace turbid {
namespace {

size_t points_that_fit(const CacheSettings& settings, size_t lights) {
  return settings.memory / std::max<size_t>(1, CompactDistributions::bytes_for(1, lights));
}

}  // namespace

ImportanceCache::ImportanceCache(const CacheSettings& settings, size_t lights,
                                 const std::array<float, kPlaceKinds>& spacing, const Recorder& record,
                                 std::unique_ptr<NearLights> near)
    : lights_(lights),
      nearest_(std::clamp<size_t>(settings.nearest, 1, kMostNearest)),
      shares_(settings.shares),
      near_(std::move(near)) {
  std::vector<PlaceKind> kinds;
  const size_t asked = std::accumulate(settings.points.begin(), settings.points.end(), size_t{0});
  const size_t fit = points_that_fit(settings, lights);
  cut_ = asked > fit;
  for (size_t k = 0; k < kPlaceKinds; ++k) {
    kinds_[k].spacing = spacing[k];
    const size_t count = cut_ ? settings.points[k] * fit / asked : settings.points[k];
    kinds.insert(kinds.end(), count, static_cast<PlaceKind>(k));
  }
  rows_ = CompactDistributions(kinds.size(), lights);
  std::vector<Record> records(kinds.size());
  parallel_for(kinds.size(), [&](size_t i) {
    thread_local std::vector<float> weights;
    weights.assign(lights, 0.0f);
    records[i] = record(kinds[i], i, weights);
    if (records[i].valid) rows_.set(i, weights);
  });
  std::array<std::vector<Tree::Point>, kPlaceKinds> places;
  for (size_t i = 0; i < kinds.size(); ++i) {
    if (!records[i].valid) continue;
    const auto k = static_cast<size_t>(kinds[i]);
    kinds_[k].rows.push_back(static_cast<uint32_t>(i));
    places[k].push_back(kinds_[k].where(records[i].position, records[i].direction));
  }
  for (size_t k = 0; k < kPlaceKinds; ++k) {
    blend(places[k], kinds_[k].rows);
    kinds_[k].tree = Tree(std::move(places[k]));
  }
}

// What a light brings varies with shadows: it may be dark at the nearest points and bright at the place. Where it is
// bright at points around these, their mean finds it far more often than uniform choice does.
void ImportanceCache::blend(const std::vector<Tree::Point>& places, const std::vector<uint32_t>& rows) {
  if (rows.empty() || (shares_.group == 0 && shares_.all == 0)) return;
  // By blocks of lights, so that sums do not depend on threads.
  constexpr size_t kBlock = 1024;
  std::vector<float> all(lights_);
  parallel_for((lights_ + kBlock - 1) / kBlock, [&](size_t block) {
    const size_t first = block * kBlock;
    const std::span<float> sums = std::span(all).subspan(first, std::min(kBlock, lights_ - first));
    for (const uint32_t row : rows) rows_.add_probs(row, 1 / static_cast<double>(rows.size()), first, sums);
  });

  const auto group_share = static_cast<float>(shares_.group), all_share = static_cast<float>(shares_.all);
  std::vector<uint32_t> order(places.size());
  std::iota(order.begin(), order.end(), 0u);
  std::vector<std::span<const uint32_t>> groups;
  for_groups(places, std::span(order), kGroup, [&](std::span<const uint32_t> group) { groups.push_back(group); });
  parallel_for(groups.size(), [&](size_t g) {
    thread_local std::vector<float> mean, mixed;
    mean.assign(lights_, 0.0f);
    for (const uint32_t i : groups[g]) rows_.add_probs(rows[i], 1 / static_cast<double>(groups[g].size()), 0, mean);
    for (const uint32_t i : groups[g]) {
      mixed.assign(lights_, 0.0f);
      rows_.add_probs(rows[i], 1 - shares_.group - shares_.all, 0, mixed);
      for (size_t light = 0; light < lights_; ++light)
        mixed[light] += group_share * mean[light] + all_share * all[light];
      rows_.set(rows[i], mixed);
    }
  });
}

size_t ImportanceCache::points() const {
  size_t count = 0;
  for (const Kind& kind : kinds_) count += kind.rows.size();
  return count;
}

ImportanceCache::Mixture ImportanceCache::mixture_at(PlaceKind kind, const Vec3& position,
                                                     const Vec3& direction) const {
  const Kind& points = kinds_[static_cast<size_t>(kind)];
  Mixture mixture;
  std::array<Tree::Neighbour, kMostNearest> found;
  mixture.count = points.tree.nearest(points.where(position, direction), std::span(found.data(), nearest_));
  for (size_t m = 0; m < mixture.count; ++m) {
    mixture.rows[m] = points.rows[found[m].index];
    // Relative to the nearest, so that no distance, however small, overflows.
    const double nearest = std::max(static_cast<double>(found[0].distance2), 1e-30);
    mixture.weights[m] = nearest / std::max(static_cast<double>(found[m].distance2), 1e-30);
  }
  if (mixture.count == 0) return mixture;
  double sum = 0;
  for (size_t m = 0; m < mixture.count; ++m) sum += mixture.weights[m];
  mixture.uniform = 0;
  for (size_t m = 0; m < mixture.count; ++m) {
    mixture.weights[m] /= sum;
    if (rows_.is_empty(mixture.rows[m])) {
      mixture.uniform += mixture.weights[m];
      mixture.weights[m] = 0;
    }
  }
  return mixture;
}

class ImportanceCache::MixtureChooser final : public LightSampler::Chooser {
 public:
  explicit MixtureChooser(const ImportanceCache& cache) : cache_(cache) {}

  void move_to(const Scatterer& place) override {
    const CacheShares& shares = cache_.shares_;
    near_ = cache_.near_ && shares.near > 0 ? NearLights::Choice(*cache_.near_, place) : NearLights::Choice();
    const bool surface = place.is_surface();
    mix(cache_.mixture_at(surface ? PlaceKind::kSurface : PlaceKind::kCollision, place.position(),
                          surface ? place.normal() : Vec3(0)),
        surface && !place.is_diffuse() ? shares.glossy : shares.uniform);
  }
  void move_along(const Ray& way) override {
    near_ = {};
    mix(cache_.mixture_at(PlaceKind::kWay, way.origin, way.direction), cache_.shares_.uniform);
  }

  std::optional<LightChoice> sample(double u) const override {
    if (cache_.lights_ == 0) return std::nullopt;
    const size_t light = light_at(u);
    return LightChoice{light, prob(light)};
  }

  double prob(size_t light) const override {
    double prob = mixture_.uniform / static_cast<double>(cache_.lights_);
    if (near_share_ > 0) prob += near_share_ * near_.prob(light);
    for (size_t m = 0; m < mixture_.count; ++m)
      if (mixture_.weights[m] > 0) prob += mixture_.weights[m] * cache_.rows_.prob(mixture_.rows[m], light);
    return prob;
  }

 private:
  std::optional<LightChoice> sample_light(double u) const override {
    if (cache_.lights_ == 0) return std::nullopt;
    return LightChoice{light_at(u), 0};
  }
  bool knows_prob_when_drawn() const override { return false; }

  /// `cached`: what the nearest points say; from now on its weights add up to 1 with all other shares.
  void mix(const Mixture& cached, double uniform) {
    near_share_ = near_.is_empty() ? 0 : cache_.shares_.near;
    const double rest = 1 - near_share_ - uniform;
    mixture_ = cached;
    for (size_t m = 0; m < mixture_.count; ++m) mixture_.weights[m] *= rest;
    mixture_.uniform = uniform + rest * cached.uniform;
  }

  static constexpr double kBelowOne = 0x1.fffffffffffffp-1;
  size_t light_at(double u) const {
    for (size_t m = 0; m < mixture_.count; ++m) {
      const double weight = mixture_.weights[m];
      if (u < weight) return cache_.rows_.sample(mixture_.rows[m], std::min(u / weight, kBelowOne)).light;
      u -= weight;
    }
    if (u < near_share_) return near_.sample(std::min(u / near_share_, kBelowOne));
    u -= near_share_;
    const double lights = static_cast<double>(cache_.lights_);
    const double at = std::clamp(u / mixture_.uniform, 0.0, kBelowOne) * lights;
    return std::min(static_cast<size_t>(at), cache_.lights_ - 1);
  }

  const ImportanceCache& cache_;
  Mixture mixture_;
  NearLights::Choice near_;
  double near_share_ = 0;
};

std::unique_ptr<LightSampler::Chooser> ImportanceCache::make_chooser() const {
  return std::make_unique<MixtureChooser>(*this);
}

}  // namespace turbid
