#include <benchmark/benchmark.h>

#include "path/join.h"
#include "path/walk.h"
#include "scene/loader.h"

/// Walks from the lights alone, and what it costs to join their vertices with others.
namespace turbid::bench {
namespace {

/// A lamp in a closed box of fog, 4 mean free paths wide, with diffuse walls.
const Scene& foggy_box() {
  static const Scene scene(load_scene_from_string(R"(<scene version="3.0.0"><sensor type="perspective"/>
    <shape type="cube"><transform name="to_world"><scale value="2"/></transform>
      <bsdf type="diffuse"><rgb name="reflectance" value="0.6"/></bsdf>
      <medium name="interior" type="homogeneous"><rgb name="sigma_t" value="1"/><rgb name="albedo" value="0.9"/>
        <phase type="hg"><float name="g" value="0.5"/></phase></medium></shape>
    <shape type="sphere"><float name="radius" value="0.1"/>
      <emitter type="area"><rgb name="radiance" value="1"/></emitter></shape></scene>)",
                                                  "box of fog")
                               .parts);
  return scene;
}

struct SegmentCounter : WalkRecorder {
  void on_segment(const Ray&, const Medium&, const PathState&, const Traveller::Leg&) { ++segments; }
  int64_t segments = 0;
};

void light_walk(benchmark::State& state) {
  const Scene& scene = foggy_box();
  const LightSources sources(scene, true);
  const PathSettings settings;
  Sampler sampler(SamplerKind::kIndependent, 1);
  SampleCounters counters;
  SegmentCounter recorder;
  LightWalk<SegmentCounter> walk(scene, settings, sampler, counters, recorder);
  uint64_t path = 0;
  for (auto _ : state) {
    sampler.start(static_cast<uint64_t>(state.thread_index()), path++);
    walk.run(sources);
  }
  state.SetItemsProcessed(recorder.segments);
}
BENCHMARK(light_walk)->Threads(1)->Threads(2)->UseRealTime();

/// The vertices of some light paths, and the other ends of the lines to them.
struct VertexKeeper : WalkRecorder {
  void at_surface(const SurfaceEvent& event, const PathState& state, const Traveller& traveller) {
    vertices.emplace_back(event, state, traveller.medium());
  }
  void at_collision(const CollisionEvent& event, const PathState& state, const Traveller&) {
    vertices.emplace_back(event, state);
  }
  std::vector<Vertex> vertices;
};

const std::vector<Vertex>& some_vertices() {
  static const std::vector<Vertex> vertices = [] {
    const LightSources sources(foggy_box(), true);
    const PathSettings settings;
    Sampler sampler(SamplerKind::kIndependent, 2);
    SampleCounters counters;
    VertexKeeper keeper;
    LightWalk<VertexKeeper> walk(foggy_box(), settings, sampler, counters, keeper);
    for (uint64_t path = 0; path < 1000; ++path) {
      sampler.start(path, 0);
      walk.run(sources);
    }
    return keeper.vertices;
  }();
  return vertices;
}

/// Calls act(first, second, traveller at the first) for pairs of vertices.
template <class Act>
void for_pairs(benchmark::State& state, const Act& act) {
  const Scene& scene = foggy_box();
  const std::vector<Vertex>& vertices = some_vertices();
  Sampler sampler(SamplerKind::kIndependent, 3);
  sampler.start(0, 0);
  SampleCounters counters;
  Traveller traveller(scene, true, sampler, counters);
  traveller.start({vertices[0].position, Vec3(0, 0, 1)}, scene.objects()[0].interior.get(), MediumStack());
  size_t first = 0;
  for (auto _ : state) {
    const Vertex& a = vertices[first % vertices.size()];
    const Vertex& b = vertices[(first * 7919 + 17) % vertices.size()];
    act(a, b, traveller);
    ++first;
  }
  state.SetItemsProcessed(static_cast<int64_t>(state.iterations()));
}

void connection_shadow_ray(benchmark::State& state) {
  for_pairs(state, [](const Vertex& a, const Vertex& b, const Traveller& traveller) {
    const Vec3 wi = normalize(b.position - a.position);
    benchmark::DoNotOptimize(look_along(traveller, a, line_between(a.leave(wi), b.leave(-wi))));
  });
}
BENCHMARK(connection_shadow_ray);

void connection_whole(benchmark::State& state) {
  const StrategyWeights weights(StrategyWeights::Heuristic::kPower);
  for_pairs(state, [&](const Vertex& a, const Vertex& b, const Traveller& traveller) {
    benchmark::DoNotOptimize(join(foggy_box(), weights, a, b, traveller));
  });
}
BENCHMARK(connection_whole);

}  // namespace
}  // namespace turbid::bench
