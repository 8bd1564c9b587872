#include <benchmark/benchmark.h>

#include "gathering/light_depositor.h"
#include "medium/majorant_grid.h"
#include "scene/loader.h"

/// How light segments find gathering volumes: Embree's hierarchy over boxes (VolumeIndex, what is used), Embree's own
/// disks that face the ray, and a uniform grid.
namespace turbid::bench {
namespace {

/// A room of thin fog, half a mean free path wide, seen through a pinhole; a lamp in the middle.
const Scene& foggy_room() {
  static const Scene scene(load_scene_from_string(R"(<scene version="3.0.0">
    <medium type="homogeneous" id="fog"><rgb name="sigma_t" value="0.125"/><rgb name="albedo" value="1"/>
      <phase type="hg"><float name="g" value="0.5"/></phase></medium>
    <sensor type="perspective"><float name="fov" value="60"/><ref name="medium" id="fog"/>
      <transform name="to_world"><lookat origin="0, -1.9, 0" target="0, 0, 0" up="0, 0, 1"/></transform>
      <film type="hdrfilm"><integer name="width" value="256"/><integer name="height" value="256"/></film></sensor>
    <shape type="cube"><transform name="to_world"><scale value="2"/></transform><boolean name="flip_normals" value="true"/>
      <bsdf type="diffuse"><rgb name="reflectance" value="0.6"/></bsdf><ref name="interior" id="fog"/>
      <ref name="exterior" id="fog"/></shape>
    <emitter type="point"><point name="position" value="0, 0, 1"/></emitter></scene>)",
                                                  "foggy room")
                               .parts);
  return scene;
}

const PathSettings& paths() {
  static const PathSettings settings;
  return settings;
}

/// What one image leaves; `share`: q, or 0 for cylinders.
std::vector<GatherVolume> volumes_of(double q) {
  GatherSettings gather;
  if (q > 0)
    gather.q = static_cast<float>(q);
  else
    gather.volumes = GatherSettings::Volumes::kCylinders;
  const GatherRadius radius = radius_in_pixels(foggy_room(), 1);
  const GatherPlan plan{foggy_room(), paths(), gather, radius, radius, true};
  Sampler sampler(SamplerKind::kIndependent, 1);
  SampleCounters counters;
  SensorGatherer gatherer(plan, sampler, counters);
  CameraWalk<SensorGatherer> walk(foggy_room(), paths(), sampler, counters, gatherer);
  Gathering result;
  for (uint32_t pixel = 0; pixel < 256 * 256; ++pixel) {
    sampler.start(pixel, 0);
    const Vec2 film((static_cast<float>(pixel % 256) + 0.5f) / 256, (static_cast<float>(pixel / 256) + 0.5f) / 256);
    const SensorRay camera = foggy_room().sensor().sample_ray(film, Vec2(0.5f));
    gatherer.begin(pixel, camera, result);
    walk.run(camera);
  }
  return result.volumes;
}

struct SegmentKeeper : WalkRecorder {
  void on_segment(const Ray& ray, const Medium&, const PathState&, const Traveller::Leg&) { segments.push_back(ray); }
  std::vector<Ray> segments;
};

const std::vector<Ray>& segments() {
  static const std::vector<Ray> kept = [] {
    const LightSources sources(foggy_room(), true);
    Sampler sampler(SamplerKind::kIndependent, 2);
    SampleCounters counters;
    SegmentKeeper keeper;
    LightWalk<SegmentKeeper> walk(foggy_room(), paths(), sampler, counters, keeper);
    for (uint64_t path = 0; path < 20000; ++path) {
      sampler.start(path, 0);
      walk.run(sources);
    }
    return keeper.segments;
  }();
  return kept;
}

/// A uniform grid whose cells list the boxes that they touch. A sphere counts in the cell where the ray crosses its
/// disk, a cylinder in the first that the two share.
class Grid {
 public:
  explicit Grid(const std::vector<GatherVolume>& volumes) : volumes_(volumes), cells_(make_cells(volumes)) {
    const auto [nx, ny, nz] = cells_.cell_counts();
    std::vector<uint32_t> counts(static_cast<size_t>(nx) * static_cast<size_t>(ny) * static_cast<size_t>(nz) + 1);
    for (int fill = 0; fill < 2; ++fill) {
      for (uint32_t i = 0; i < volumes.size(); ++i)
        for_cells(volumes[i].bounds(), [&](size_t cell) {
          if (fill == 0)
            ++counts[cell + 1];
          else
            entries_[counts[cell]++] = i;
        });
      if (fill == 1) break;
      for (size_t c = 1; c < counts.size(); ++c) counts[c] += counts[c - 1];
      starts_ = counts;
      entries_.resize(counts.back());
    }
  }

  template <class Visit>
  void along(const Ray& ray, const Visit& visit) const {
    const MajorantCell* first = &cells_.cell(0, 0, 0);
    cells_.walk(ray, [&](const MajorantCell& cell, float from, float to) {
      const auto number = static_cast<size_t>(&cell - first);
      for (uint32_t k = starts_[number]; k < starts_[number + 1]; ++k) visit(entries_[k], from, to);
      return true;
    });
  }
  size_t entries() const { return entries_.size(); }

 private:
  static MajorantGrid make_cells(const std::vector<GatherVolume>& volumes) {
    Bounds3 box;
    for (const GatherVolume& volume : volumes) box.extendBy(volume.bounds());
    // About as many cells as volumes, up to 2^24.
    const double n = std::min(256.0, std::cbrt(static_cast<double>(volumes.size())));
    const int cells = std::max(1, static_cast<int>(n));
    return {box, {cells, cells, cells}};
  }
  template <class Act>
  void for_cells(const Bounds3& box, const Act& act) const {
    const auto [nx, ny, nz] = cells_.cell_counts();
    const auto place = [&](float x, unsigned a, int n) {
      const float size = cells_.box().max[a] - cells_.box().min[a];
      return std::clamp(static_cast<int>((x - cells_.box().min[a]) / size * static_cast<float>(n)), 0, n - 1);
    };
    for (int z = place(box.min.z, 2, nz); z <= place(box.max.z, 2, nz); ++z)
      for (int y = place(box.min.y, 1, ny); y <= place(box.max.y, 1, ny); ++y)
        for (int x = place(box.min.x, 0, nx); x <= place(box.max.x, 0, nx); ++x)
          act((static_cast<size_t>(z) * static_cast<size_t>(ny) + static_cast<size_t>(y)) * static_cast<size_t>(nx) +
              static_cast<size_t>(x));
  }

  const std::vector<GatherVolume>& volumes_;
  MajorantGrid cells_;
  std::vector<uint32_t> starts_, entries_;
};

/// Embree's disks that face the ray, found by a filter that takes none for good.
class FacingDisks {
 public:
  explicit FacingDisks(const std::vector<GatherVolume>& volumes) : device_(rtcNewDevice(nullptr)) {
    scene_ = rtcNewScene(device_);
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_DISC_POINT);
    auto* points = static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 16, volumes.size()));
    for (const GatherVolume& volume : volumes) {
      for (const float x : {volume.origin.x, volume.origin.y, volume.origin.z, volume.radius}) *points++ = x;
    }
    rtcSetGeometryOccludedFilterFunction(geometry, [](const RTCFilterFunctionNArguments* args) {
      ++reinterpret_cast<Query*>(args->context)->found;
      args->valid[0] = 0;
    });
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    rtcCommitScene(scene_);
  }
  ~FacingDisks() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  FacingDisks(const FacingDisks&) = delete;
  FacingDisks& operator=(const FacingDisks&) = delete;

  int64_t count(const Ray& ray) const {
    Query query{{}, 0};
    rtcInitIntersectContext(&query.context);
    alignas(16) RTCRay cast = embree_ray(ray, ray.t_max);
    rtcOccluded1(scene_, &query.context, &cast);
    return query.found;
  }

 private:
  struct Query {
    RTCIntersectContext context;
    int64_t found;
  };
  RTCDevice device_;
  RTCScene scene_;
};

bool crosses(const Ray& ray, const GatherVolume& volume) {
  return volume.is_sphere() ? nearest_within(ray, volume.origin, volume.radius) > 0 : !chord_in(ray, volume).empty();
}

double q_of(const benchmark::State& state) { return static_cast<double>(state.range(0)) / 1000; }

/// Looks all segments up; `count(ray)` says how many volumes one crosses.
template <class Count>
void look_up(benchmark::State& state, size_t volumes, const Count& count) {
  size_t next = 0;
  int64_t found = 0;
  for (auto _ : state) {
    found += count(segments()[next]);
    next = (next + 1) % segments().size();
  }
  state.SetItemsProcessed(static_cast<int64_t>(state.iterations()));
  state.counters["volumes"] = static_cast<double>(volumes);
  state.counters["crossed"] = static_cast<double>(found) / static_cast<double>(state.iterations());
}

void gather_hierarchy(benchmark::State& state) {
  const auto volumes = volumes_of(q_of(state));
  VolumeIndex index;
  index.build(volumes.size(), [&](size_t i) { return volumes[i].bounds(); });
  look_up(state, volumes.size(), [&](const Ray& ray) {
    int64_t found = 0;
    index.along(ray, [&](uint32_t i) { found += crosses(ray, volumes[i]); });
    return found;
  });
}
BENCHMARK(gather_hierarchy)->Arg(1000)->Arg(100)->Arg(10)->Arg(0);

void gather_facing_disks(benchmark::State& state) {
  const auto volumes = volumes_of(q_of(state));
  const FacingDisks disks(volumes);
  look_up(state, volumes.size(), [&](const Ray& ray) { return disks.count(ray); });
}
BENCHMARK(gather_facing_disks)->Arg(1000)->Arg(100)->Arg(10);

void gather_grid(benchmark::State& state) {
  const auto volumes = volumes_of(q_of(state));
  const Grid grid(volumes);
  look_up(state, volumes.size(), [&](const Ray& ray) {
    int64_t found = 0;
    grid.along(ray, [&](uint32_t i, float from, float to) {
      if (volumes[i].is_sphere()) {
        const float t = nearest_within(ray, volumes[i].origin, volumes[i].radius);
        found += t >= from && t < to;
      } else {
        const Chord chord = chord_in(ray, volumes[i]);
        const auto begins = static_cast<float>(chord.from);
        found += !chord.empty() && begins >= from && begins < to;
      }
    });
    return found;
  });
  state.counters["entries"] = static_cast<double>(grid.entries());
}
BENCHMARK(gather_grid)->Arg(1000)->Arg(100)->Arg(10)->Arg(0);

void gather_hierarchy_build(benchmark::State& state) {
  const auto volumes = volumes_of(q_of(state));
  VolumeIndex index;
  for (auto _ : state) index.build(volumes.size(), [&](size_t i) { return volumes[i].bounds(); });
  state.SetItemsProcessed(static_cast<int64_t>(state.iterations() * volumes.size()));
}
BENCHMARK(gather_hierarchy_build)->Arg(1000)->Arg(100)->Arg(10)->Arg(0)->UseRealTime();

void gather_grid_build(benchmark::State& state) {
  const auto volumes = volumes_of(q_of(state));
  for (auto _ : state) benchmark::DoNotOptimize(Grid(volumes).entries());
  state.SetItemsProcessed(static_cast<int64_t>(state.iterations() * volumes.size()));
}
BENCHMARK(gather_grid_build)->Arg(1000)->Arg(100)->Arg(10)->Arg(0)->UseRealTime();

}  // namespace
}  // namespace turbid::bench
