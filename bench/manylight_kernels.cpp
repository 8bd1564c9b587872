#include <benchmark/benchmark.h>

#include "core/rng.h"
#include "core/warp.h"
#include "manylight/segment_pairs.h"
#include "manylight/virtual_lights.h"
#include "medium/homogeneous.h"
#include "scene/loader.h"

/// What a virtual ray light brings to a way of the sensor's walk, and a point light to a place, without the shadow ray.
namespace turbid::bench {
namespace {

struct Pairs {
  std::vector<Ray> lights, sensors;
  static constexpr size_t kCount = 1024;

  Pairs() {
    Rng rng(3);
    const auto segment = [&] {
      const float u = rng.next_float();
      const Vec3 direction = square_to_sphere({u, rng.next_float()});
      return Ray{Vec3(rng.next_float(), rng.next_float(), rng.next_float()), direction, 0.1f + rng.next_float()};
    };
    for (size_t i = 0; i < kCount; ++i) {
      lights.push_back(segment());
      sensors.push_back(segment());
    }
  }
};

/// Places on both segments alone. The argument: g of both lobes, in hundredths.
void segment_pair(benchmark::State& state) {
  static const Pairs pairs;
  const float g = static_cast<float>(state.range(0)) / 100;
  size_t i = 0;
  float u = 0.1f;
  for (auto _ : state) {
    u = u < 0.9f ? u + 0.037f : 0.01f;
    benchmark::DoNotOptimize(sample_pair(pairs.lights[i], pairs.sensors[i * 7 % Pairs::kCount], {g, g}, {u, 1 - u}));
    i = (i + 1) % Pairs::kCount;
  }
  state.SetItemsProcessed(static_cast<int64_t>(state.iterations()));
}
BENCHMARK(segment_pair)->Arg(0)->Arg(80);

/// The same by vectors: many lights for one segment of the sensor.
void segment_pairs_by_vectors(benchmark::State& state) {
  static const Pairs pairs;
  const float g = static_cast<float>(state.range(0)) / 100;
  std::vector<PairRequest> requests;
  for (size_t i = 0; i < Pairs::kCount; ++i) {
    const float u = (static_cast<float>(i * 37 % Pairs::kCount) + 0.5f) / Pairs::kCount;
    requests.push_back({&pairs.lights[i], g, {u, 1 - u}});
  }
  std::vector<SegmentPair> found(Pairs::kCount);
  size_t i = 0;
  for (auto _ : state) {
    sample_pairs(requests, pairs.sensors[i++ % Pairs::kCount], g, found);
    benchmark::DoNotOptimize(found.data());
  }
  state.SetItemsProcessed(static_cast<int64_t>(state.iterations() * Pairs::kCount));
}
BENCHMARK(segment_pairs_by_vectors)->Arg(0)->Arg(80);

/// The whole value but for the shadow ray: places, transmittances, phase functions.
void ray_light_pair(benchmark::State& state) {
  static const Pairs pairs;
  const float g = static_cast<float>(state.range(0)) / 100;
  const auto loaded = load_scene_from_string(
      R"(<scene version="3.0.0"><sensor type="perspective"/><shape type="sphere"><bsdf type="null"/>
      <medium name="interior" type="homogeneous"><rgb name="sigma_t" value="0.3, 0.4, 0.5"/><rgb name="albedo"
      value="0.9"/><phase type="hg"><float name="g" value=")" +
          std::to_string(g) + R"("/></phase></medium></shape></scene>)",
      "fog", {});
  const HomogeneousMedium& medium = *loaded.parts.objects[0].interior->as_homogeneous();
  std::vector<CollisionSegment> lights, ways;
  for (size_t i = 0; i < Pairs::kCount; ++i) {
    lights.push_back(CollisionSegment::of_light(pairs.lights[i], medium, {Spectrum(1.0f), 0, 0}, 1));
    ways.push_back(CollisionSegment::of_sensor(pairs.sensors[i], medium, {Spectrum(1.0f), 0, 0}));
  }
  Sampler sampler(SamplerKind::kIndependent, 1);
  sampler.start(0, 0);
  const LineSettings settings;
  std::vector<PairRequest> requests;
  for (size_t i = 0; i < Pairs::kCount; ++i) {
    const float u = (static_cast<float>(i * 37 % Pairs::kCount) + 0.5f) / Pairs::kCount;
    requests.push_back({&lights[i].way(), g, {u, 1 - u}});
  }
  std::vector<SegmentPair> found(Pairs::kCount);
  size_t k = 0;
  for (auto _ : state) {
    const CollisionSegment& way = ways[k++ % Pairs::kCount];
    sample_pairs(requests, way.way(), way.g(), found);
    for (size_t i = 0; i < Pairs::kCount; ++i)
      benchmark::DoNotOptimize(unshadowed(way.place_at(found[i].on_sensor, 1, sampler),
                                          lights[i].place_at(found[i].on_light, found[i].pdf, sampler), settings));
  }
  state.SetItemsProcessed(static_cast<int64_t>(state.iterations() * Pairs::kCount));
}
BENCHMARK(ray_light_pair)->Arg(0)->Arg(80);

}  // namespace
}  // namespace turbid::bench
