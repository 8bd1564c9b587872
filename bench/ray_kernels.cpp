#include <benchmark/benchmark.h>
#include <embree3/rtcore.h>

#include <array>

#include "core/rng.h"
#include "core/warp.h"
#include "geometry/generated.h"
#include "geometry/ray_caster.h"
#include "geometry/sphere.h"
#include "geometry/triangle_mesh.h"

/// Rays per second, of one thread. Incoherent rays, as scattering makes them: from a sphere around the scene towards
/// points inside. What RayCaster adds to Embree shows against Embree alone on the same mesh and the same rays.
namespace turbid {
namespace {

constexpr size_t kRays = 1 << 16;

const MeshData& bumpy_mesh() {
  static const MeshData mesh = make_bumpy_sphere(1, 0.2f, 3, 1, 7);  // 327680 triangles
  return mesh;
}

const std::vector<Ray>& incoherent_rays() {
  static const std::vector<Ray> rays = [] {
    Rng rng(7);
    const auto next = [&] {
      const float u = rng.next_float();
      return Vec2(u, rng.next_float());
    };
    std::vector<Ray> result(kRays);
    for (Ray& ray : result) {
      const Vec3 from = square_to_sphere(next()) * 2.0f;
      const Vec3 to = square_to_sphere(next()) * std::cbrt(rng.next_float());
      ray = {from, normalize(to - from), kInfinity};
    }
    return result;
  }();
  return rays;
}

void report_rays(benchmark::State& state) { state.SetItemsProcessed(state.iterations() * static_cast<int64_t>(kRays)); }

/// Embree and nothing else: one geometry, its own buffers.
class PlainEmbree {
 public:
  PlainEmbree(const MeshData& mesh, RTCSceneFlags flags)
      : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* positions = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.positions.size()));
    for (const Vec3& p : mesh.positions)
      for (int axis = 0; axis < 3; ++axis) *positions++ = p[axis];
    auto* indices = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                   3 * sizeof(uint32_t), mesh.triangle_count()));
    std::copy(mesh.indices.begin(), mesh.indices.end(), indices);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcSetSceneFlags(scene_, flags);
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
    rtcCommitScene(scene_);
  }
  ~PlainEmbree() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  PlainEmbree(const PlainEmbree&) = delete;
  PlainEmbree& operator=(const PlainEmbree&) = delete;

  float nearest(const Ray& ray) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit query{embree_ray(ray, ray.t_max), {}};
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_, &context, &query);
    return query.ray.tfar;
  }
  bool occluded(const Ray& ray) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay query = embree_ray(ray, ray.t_max);
    rtcOccluded1(scene_, &context, &query);
    return query.tfar < 0;
  }

 private:
  RTCDevice device_;
  RTCScene scene_;
};

void embree_nearest(benchmark::State& state, RTCSceneFlags flags) {
  const PlainEmbree embree(bumpy_mesh(), flags);
  for (auto _ : state)
    for (const Ray& ray : incoherent_rays()) benchmark::DoNotOptimize(embree.nearest(ray));
  report_rays(state);
}
BENCHMARK_CAPTURE(embree_nearest, robust, RTC_SCENE_FLAG_ROBUST)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(embree_nearest, fast, RTC_SCENE_FLAG_NONE)->Unit(benchmark::kMillisecond);

void embree_occluded(benchmark::State& state) {
  const PlainEmbree embree(bumpy_mesh(), RTC_SCENE_FLAG_ROBUST);
  for (auto _ : state)
    for (const Ray& ray : incoherent_rays()) benchmark::DoNotOptimize(embree.occluded(ray));
  report_rays(state);
}
BENCHMARK(embree_occluded)->Unit(benchmark::kMillisecond);

RayCaster mesh_caster() { return RayCaster({std::make_shared<TriangleMesh>(bumpy_mesh())}); }

void ray_nearest(benchmark::State& state) {
  const RayCaster caster = mesh_caster();
  for (auto _ : state)
    for (const Ray& ray : incoherent_rays()) benchmark::DoNotOptimize(caster.intersect(ray).t);
  report_rays(state);
}
BENCHMARK(ray_nearest)->Unit(benchmark::kMillisecond);

/// With all that shading needs: normals, uvs, derivatives, error bound.
void ray_nearest_and_surface_point(benchmark::State& state) {
  const RayCaster caster = mesh_caster();
  for (auto _ : state)
    for (const Ray& ray : incoherent_rays())
      if (const Hit hit = caster.intersect(ray))
        benchmark::DoNotOptimize(caster.shape(hit.shape).surface_point(ray, hit).shading.n);
  report_rays(state);
}
BENCHMARK(ray_nearest_and_surface_point)->Unit(benchmark::kMillisecond);

void ray_occluded(benchmark::State& state) {
  const RayCaster caster = mesh_caster();
  for (auto _ : state)
    for (const Ray& ray : incoherent_rays()) benchmark::DoNotOptimize(caster.occluded(ray));
  report_rays(state);
}
BENCHMARK(ray_occluded)->Unit(benchmark::kMillisecond);

void ray_clearance(benchmark::State& state) {
  const RayCaster caster = mesh_caster();
  for (auto _ : state)
    for (const Ray& ray : incoherent_rays()) benchmark::DoNotOptimize(caster.clearance(ray.at(1.5f), 1));
  report_rays(state);
}
BENCHMARK(ray_clearance)->Unit(benchmark::kMillisecond);

void ray_nearest_sphere(benchmark::State& state) {
  const RayCaster caster({std::make_shared<Sphere>(Vec3(0, 0, 0), 1.0f)});
  for (auto _ : state)
    for (const Ray& ray : incoherent_rays()) benchmark::DoNotOptimize(caster.intersect(ray).t);
  report_rays(state);
}
BENCHMARK(ray_nearest_sphere)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace turbid
