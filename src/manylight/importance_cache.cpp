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
                                 const std::array<float, kPlaceKinds>& spacing, const Recorder& record)
    : lights_(lights), nearest_(std::clamp<size_t>(settings.nearest, 1, kMostNearest)) {
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
  for (size_t k = 0; k < kPlaceKinds; ++k) kinds_[k].tree = Tree(std::move(places[k]));
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
  const double uniform = sum / static_cast<double>(mixture.count), all = sum + uniform;
  mixture.uniform = uniform / all;
  for (size_t m = 0; m < mixture.count; ++m) {
    mixture.weights[m] /= all;
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
    mixture_ = place.is_surface() ? cache_.mixture_at(PlaceKind::kSurface, place.position(), place.normal())
                                  : cache_.mixture_at(PlaceKind::kCollision, place.position(), Vec3(0));
  }
  void move_along(const Ray& way) override { mixture_ = cache_.mixture_at(PlaceKind::kWay, way.origin, way.direction); }

  std::optional<LightChoice> sample(double u) const override {
    if (cache_.lights_ == 0) return std::nullopt;
    for (size_t m = 0; m < mixture_.count; ++m) {
      const double weight = mixture_.weights[m];
      if (u < weight) return choice(cache_.rows_.sample(mixture_.rows[m], std::min(u / weight, kBelowOne)).light);
      u -= weight;
    }
    const double lights = static_cast<double>(cache_.lights_);
    return choice(static_cast<size_t>(std::clamp(u / mixture_.uniform, 0.0, kBelowOne) * lights));
  }

  double prob(size_t light) const override {
    double prob = mixture_.uniform / static_cast<double>(cache_.lights_);
    for (size_t m = 0; m < mixture_.count; ++m)
      if (mixture_.weights[m] > 0) prob += mixture_.weights[m] * cache_.rows_.prob(mixture_.rows[m], light);
    return prob;
  }

 private:
  static constexpr double kBelowOne = 0x1.fffffffffffffp-1;
  LightChoice choice(size_t light) const {
    light = std::min(light, cache_.lights_ - 1);
    return {light, prob(light)};
  }

  const ImportanceCache& cache_;
  Mixture mixture_;
};

std::unique_ptr<LightSampler::Chooser> ImportanceCache::make_chooser() const {
  return std::make_unique<MixtureChooser>(*this);
}

}  // namespace turbid
