#include <benchmark/benchmark.h>

#include "gathering/volume_index.h"
#include "photon/photon_recorder.h"
#include "scene/loader.h"

/// How photons are found: points by a k-d tree (PointTree, what is used) or by Embree's hierarchy over boxes around
/// them (VolumeIndex); beams by that hierarchy, whole or in pieces.
namespace turbid::bench {
namespace {

/// A room of fog, four mean free paths wide, with a lamp in the middle.
const Scene& foggy_room() {
  static const Scene scene(load_scene_from_string(R"(<scene version="3.0.0">
    <medium type="homogeneous" id="fog"><rgb name="sigma_t" value="1"/><rgb name="albedo" value="0.95"/></medium>
    <sensor type="perspective"><ref name="medium" id="fog"/></sensor>
    <shape type="cube"><transform name="to_world"><scale value="2"/></transform><boolean name="flip_normals" value="true"/>
      <bsdf type="diffuse"><rgb name="reflectance" value="0.6"/></bsdf><ref name="interior" id="fog"/>
      <ref name="exterior" id="fog"/></shape>
    <emitter type="point"><point name="position" value="0, 0, 1"/></emitter></scene>)",
                                                  "foggy room")
                               .parts);
  return scene;
}

Photons photons_of(size_t paths, bool beams) {
  const StrategyWeights weights(StrategyWeights::Heuristic::kBalance, {1, 1, 1, 1, 1, 1});
  const LightSources sources(foggy_room(), true);
  PathSettings settings;
  Sampler sampler(SamplerKind::kIndependent, 1);
  SampleCounters counters;
  PhotonRecorder recorder(foggy_room(), weights, {!beams, false, false, beams, false}, nullptr, counters);
  LightWalk<PhotonRecorder> walk(foggy_room(), settings, sampler, counters, recorder);
  Photons result;
  for (uint64_t path = 0; path < paths; ++path) {
    sampler.start(path, 0);
    recorder.begin(beams, result);
    walk.run(sources);
  }
  return result;
}

/// Flights of other paths through the same room.
const std::vector<Ray>& flights() {
  static const std::vector<Ray> result = [] {
    std::vector<Ray> rays;
    for (const PhotonBeam& beam : photons_of(5000, true).beams) rays.push_back(beam.ray());
    std::reverse(rays.begin(), rays.end());
    return rays;
  }();
  return result;
}

constexpr float kRadius = 0.01f;

std::vector<Vec3> positions_of(const Photons& photons) {
  std::vector<Vec3> result;
  for (const PhotonPoint& photon : photons.collisions) result.push_back(photon.position);
  return result;
}

Bounds3 box_around(const Vec3& p) { return {p - Vec3(kRadius), p + Vec3(kRadius)}; }

template <class Look>
void look_up(benchmark::State& state, const Look& look) {
  size_t i = 0;
  uint64_t found = 0;
  for (auto _ : state) {
    look(flights()[i], [&](auto&&...) { ++found; });
    i = (i + 1) % flights().size();
  }
  state.counters["found"] = benchmark::Counter(static_cast<double>(found), benchmark::Counter::kAvgIterations);
}

void photon_tree_along(benchmark::State& state) {
  const std::vector<Vec3> points = positions_of(photons_of(static_cast<size_t>(state.range(0)), false));
  PointTree tree;
  tree.build(points);
  look_up(state, [&](const Ray& ray, const auto& visit) { tree.along(ray, kRadius, visit); });
}
void photon_boxes_along(benchmark::State& state) {
  const std::vector<Vec3> points = positions_of(photons_of(static_cast<size_t>(state.range(0)), false));
  VolumeIndex index;
  index.build(points.size(), [&](size_t i) { return box_around(points[i]); });
  look_up(state, [&](const Ray& ray, const auto& visit) { index.along(ray, visit); });
}
void photon_tree_around(benchmark::State& state) {
  const std::vector<Vec3> points = positions_of(photons_of(static_cast<size_t>(state.range(0)), false));
  PointTree tree;
  tree.build(points);
  look_up(state, [&](const Ray& ray, const auto& visit) { tree.around(ray.origin, kRadius, visit); });
}
void photon_boxes_around(benchmark::State& state) {
  const std::vector<Vec3> points = positions_of(photons_of(static_cast<size_t>(state.range(0)), false));
  VolumeIndex index;
  index.build(points.size(), [&](size_t i) { return box_around(points[i]); });
  look_up(state, [&](const Ray& ray, const auto& visit) { index.around(ray.origin, visit); });
}
void photon_tree_build(benchmark::State& state) {
  const std::vector<Vec3> points = positions_of(photons_of(static_cast<size_t>(state.range(0)), false));
  PointTree tree;
  for (auto _ : state) tree.build(points);
  state.SetItemsProcessed(static_cast<int64_t>(state.iterations()) * static_cast<int64_t>(points.size()));
}
void photon_boxes_build(benchmark::State& state) {
  const std::vector<Vec3> points = positions_of(photons_of(static_cast<size_t>(state.range(0)), false));
  VolumeIndex index;
  for (auto _ : state) index.build(points.size(), [&](size_t i) { return box_around(points[i]); });
  state.SetItemsProcessed(static_cast<int64_t>(state.iterations()) * static_cast<int64_t>(points.size()));
}
void photon_beams_along(benchmark::State& state) {
  PhotonMap map;
  map.photons = photons_of(static_cast<size_t>(state.range(0)), true);
  map.index([](const HomogeneousMedium&) { return kRadius; });
  look_up(state, [&](const Ray& ray, const auto& visit) { map.beams_along(ray, visit); });
}
void photon_beams_whole(benchmark::State& state) {
  const Photons photons = photons_of(static_cast<size_t>(state.range(0)), true);
  VolumeIndex index;
  index.build(photons.beams.size(), [&](size_t i) {
    const Ray& ray = photons.beams[i].ray();
    Bounds3 box(ray.origin, ray.origin);
    box.extendBy(ray.at(ray.t_max));
    return Bounds3(box.min - Vec3(kRadius), box.max + Vec3(kRadius));
  });
  look_up(state, [&](const Ray& ray, const auto& visit) { index.along(ray, visit); });
}

BENCHMARK(photon_tree_along)->Arg(10000)->Arg(60000);
BENCHMARK(photon_boxes_along)->Arg(10000)->Arg(60000);
BENCHMARK(photon_tree_around)->Arg(10000)->Arg(60000);
BENCHMARK(photon_boxes_around)->Arg(10000)->Arg(60000);
BENCHMARK(photon_tree_build)->Arg(10000)->Arg(60000)->Unit(benchmark::kMillisecond);
BENCHMARK(photon_boxes_build)->Arg(10000)->Arg(60000)->Unit(benchmark::kMillisecond);
BENCHMARK(photon_beams_along)->Arg(5000);
BENCHMARK(photon_beams_whole)->Arg(5000);

}  // namespace
}  // namespace turbid::bench
