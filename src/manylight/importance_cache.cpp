#include "manylight/importance_cache.h"

#include "core/parallel.h"

namespace turbid {
namespace {

KdTree<6>::Point with_normal(const Vec3& p, const Vec3& n, float spacing) {
  return {p.x, p.y, p.z, n.x * spacing, n.y * spacing, n.z * spacing};
}

size_t points_that_fit(const CacheSettings& settings, size_t lights) {
  return settings.memory / std::max<size_t>(1, CompactDistributions::bytes_for(1, lights));
}

}  // namespace

ImportanceCache::ImportanceCache(const CacheSettings& settings, size_t lights, float spacing, const Recorder& record)
    : lights_(lights), nearest_(std::clamp<size_t>(settings.nearest, 1, kMostNearest)), spacing_(spacing) {
  size_t surface = settings.surface_points, count = surface + settings.volume_points;
  if (const size_t fit = points_that_fit(settings, lights); count > fit) {
    cut_ = true;
    surface = surface * fit / count;
    count = fit;
  }
  rows_ = CompactDistributions(count, lights);
  std::vector<Record> records(count);
  parallel_for(count, [&](size_t i) {
    thread_local std::vector<float> weights;
    weights.assign(lights, 0.0f);
    records[i] = record(i < surface, i, weights);
    if (records[i].valid) rows_.set(i, weights);
  });
  std::vector<KdTree<6>::Point> on_surfaces;
  std::vector<KdTree<3>::Point> in_volumes;
  for (size_t i = 0; i < count; ++i) {
    if (!records[i].valid) continue;
    const Vec3& p = records[i].position;
    (i < surface ? surfaces_ : volumes_).rows.push_back(static_cast<uint32_t>(i));
    if (i < surface)
      on_surfaces.push_back(with_normal(p, records[i].normal, spacing_));
    else
      in_volumes.push_back({p.x, p.y, p.z});
  }
  surface_tree_ = KdTree<6>(std::move(on_surfaces));
  volume_tree_ = KdTree<3>(std::move(in_volumes));
}

ImportanceCache::Mixture ImportanceCache::mixture_at(const Scatterer& place) const {
  const Vec3& p = place.position();
  Mixture mixture;
  const auto take = [&](const auto& tree, const Points& points, const auto& where) {
    std::array<typename std::remove_cvref_t<decltype(tree)>::Neighbour, kMostNearest> found;
    mixture.count = tree.nearest(where, std::span(found.data(), nearest_));
    for (size_t m = 0; m < mixture.count; ++m) {
      mixture.rows[m] = points.rows[found[m].index];
      // Relative to the nearest, so that no distance, however small, overflows.
      const double nearest = std::max(static_cast<double>(found[0].distance2), 1e-30);
      mixture.weights[m] = nearest / std::max(static_cast<double>(found[m].distance2), 1e-30);
    }
  };
  if (place.is_surface())
    take(surface_tree_, surfaces_, with_normal(p, place.normal(), spacing_));
  else
    take(volume_tree_, volumes_, KdTree<3>::Point{p.x, p.y, p.z});
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

  void move_to(const Scatterer& place) override { mixture_ = cache_.mixture_at(place); }

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
