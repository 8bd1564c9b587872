#include <benchmark/benchmark.h>

#include "path/walk.h"
#include "scene/loader.h"

/// The walk from the lights alone, without anything joined.
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

}  // namespace
}  // namespace turbid::bench
