#include <benchmark/benchmark.h>

#include <map>

#include "core/warp.h"
#include "medium/henyey_greenstein.h"
#include "table/endless_walk.h"
#include "table/multiple_scattering.h"
#include "table/quadtree_table.h"

/// What multiple scattering from tables costs, of one thread: the four queries of a grey medium, a channel at a time,
/// and the walk that tables are made by.
namespace turbid {
namespace {

constexpr size_t kPlaces = 4096;

const ScatteringTable& table(float g) {
  static std::map<float, ScatteringTable> tables;
  if (const auto found = tables.find(g); found != tables.end()) return found->second;
  const HenyeyGreensteinPhase phase(g);
  TableShape shape;
  shape.bands = choose_bands(phase);
  return tables.emplace(g, build_table(phase, shape, {1, 50'000})).first->second;
}

/// Places within a few mean free paths, and directions.
struct Places {
  std::vector<Vec3> x, w;
  Places() {
    Rng rng(1);
    const auto direction = [&] {
      const float u = rng.next_float();
      return square_to_sphere({u, rng.next_float()});
    };
    for (size_t i = 0; i < kPlaces; ++i) {
      x.push_back(direction() * (0.2f * std::exp(4 * rng.next_float())));
      w.push_back(direction());
    }
  }
};

template <class Query>
void run(benchmark::State& state, const Query& query) {
  const Places places;
  for (auto _ : state)
    for (size_t i = 0; i < kPlaces; ++i) benchmark::DoNotOptimize(query(places.x[i], places.w[i]));
  state.SetItemsProcessed(state.iterations() * static_cast<int64_t>(kPlaces));
}

void table_point_point(benchmark::State& state, float g) {
  const LobeField field(table(g), SourceKind::kCollision, 0.97);
  run(state, [&](const Vec3& x, const Vec3& w) { return field.eval(x, {0, 0, 1}, w); });
}
BENCHMARK_CAPTURE(table_point_point, isotropic, 0.0f);
BENCHMARK_CAPTURE(table_point_point, g03, 0.3f);
BENCHMARK_CAPTURE(table_point_point, g09, 0.9f);

/// All three channels, with albedos of their own.
MultipleScattering wax(float g) {
  return {HomogeneousMedium({1, 1.1f, 1.2f}, {0.98f, 1.05f, 0.9f}, std::make_shared<HenyeyGreensteinPhase>(g)),
          table(g)};
}

void table_segment_point(benchmark::State& state, float g) {
  const MultipleScattering light = wax(g);
  run(state, [&](const Vec3& x, const Vec3& w) {
    return light.source_radiance(Stretch{{0, 0, 0}, {0, 0, 1}, 2}, x, w);
  });
}
BENCHMARK_CAPTURE(table_segment_point, g03, 0.3f);
BENCHMARK_CAPTURE(table_segment_point, g09, 0.9f);

void table_point_segment(benchmark::State& state, float g) {
  const MultipleScattering light = wax(g);
  run(state, [&](const Vec3& x, const Vec3& w) { return light.radiance(Vec3(0), {0, 0, 1}, Stretch{x, w, 10}, 0.5f); });
}
BENCHMARK_CAPTURE(table_point_segment, g03, 0.3f);
BENCHMARK_CAPTURE(table_point_segment, g09, 0.9f);

void table_segment_segment(benchmark::State& state, float g) {
  const MultipleScattering light = wax(g);
  run(state, [&](const Vec3& x, const Vec3& w) {
    return light.radiance(Stretch{{0, 0, 0}, {0, 0, 1}, 2}, Stretch{x, w, 10}, 0.5f);
  });
}
BENCHMARK_CAPTURE(table_segment_segment, g03, 0.3f);
BENCHMARK_CAPTURE(table_segment_segment, g09, 0.9f);

/// The same as published.
void table_seed_segment_segment(benchmark::State& state) {
  const HenyeyGreensteinPhase phase(0.9f);
  const Spectrum sigma_t(1, 1.1f, 1.2f), sigma_s(0.98f, 1.05f, 0.9f);
  const HomogeneousMedium medium(sigma_t, sigma_s, std::make_shared<HenyeyGreensteinPhase>(0.9f));
  const MultipleScattering light(
      medium,
      quadtree_lights(std::make_shared<QuadtreeTable>(build_quadtree_table(phase, medium.albedo(), {1, 5000}))));
  run(state, [&](const Vec3& x, const Vec3& w) {
    return light.radiance(Stretch{{0, 0, 0}, {0, 0, 1}, 2}, Stretch{x, w, 10}, 0.5f);
  });
}
BENCHMARK(table_seed_segment_segment);

void table_walk(benchmark::State& state) {
  const HenyeyGreensteinPhase phase(0.9f);
  EndlessWalks walks(phase, 16, 1);
  for (auto _ : state)
    for (size_t i = 0; i < kPlaces; i += EndlessWalks::kCount) walks.step();
  benchmark::DoNotOptimize(walks.back(0, 0));
  state.SetItemsProcessed(state.iterations() * static_cast<int64_t>(kPlaces));
}
BENCHMARK(table_walk);

}  // namespace
}  // namespace turbid
