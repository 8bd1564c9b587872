#include "geometry/ray_caster.h"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <stdexcept>

namespace turbid {
namespace {
/// Beyond this many primitives the best hierarchy costs too much time and memory to build.
constexpr size_t kManyPrimitives = 2'000'000;

/// How much nearer than the nearest surface found so far another must be to be looked for. Surfaces at nearly the same
/// distance are many (a sphere seen from its middle), and a bound need not tell them apart.
constexpr float kWorthLooking = 0.75f;

struct NearestQuery {
  const std::vector<std::shared_ptr<const Shape>>& shapes;
  float distance;
};

bool visit_primitive(RTCPointQueryFunctionArguments* args) {
  auto& nearest = *static_cast<NearestQuery*>(args->userPtr);
  const float distance =
      nearest.shapes[args->geomID]->distance_bound({args->query->x, args->query->y, args->query->z}, args->primID);
  if (!(distance < nearest.distance)) return false;
  nearest.distance = distance;
  args->query->radius = kWorthLooking * distance;
  return true;
}
}  // namespace

RayCaster::RayCaster(std::vector<std::shared_ptr<const Shape>> shapes) : shapes_(std::move(shapes)) {
  std::vector<uint32_t> spheres, others;
  size_t primitives = 0;
  for (uint32_t i = 0; i < shapes_.size(); ++i) {
    bounds_.extendBy(shapes_[i]->bounds());
    if (dynamic_cast<const Sphere*>(shapes_[i].get()) != nullptr)
      spheres.push_back(i);
    else
      others.push_back(i);
  }
  if (spheres.size() > kMaxLoneSpheres) {
    others.insert(others.end(), spheres.begin(), spheres.end());
    spheres.clear();
  }
  for (const uint32_t i : spheres) spheres_.push_back({static_cast<const Sphere*>(shapes_[i].get()), i});
  if (others.empty()) return;

  device_ = rtcNewDevice(nullptr);
  if (device_ == nullptr)
    throw std::runtime_error(
        fmt::format("Embree does not start (error {})", static_cast<int>(rtcGetDeviceError(nullptr))));
  scene_ = rtcNewScene(device_);
  for (const uint32_t i : others) {
    primitives += shapes_[i]->primitive_count();
    RTCGeometry geometry = shapes_[i]->make_embree_geometry(device_);
    rtcAttachGeometryByID(scene_, geometry, i);
    rtcReleaseGeometry(geometry);
  }
  const bool many = primitives > kManyPrimitives;
  // Robust: watertight along shared edges, and no bounding box is missed by rounding.
  rtcSetSceneFlags(scene_, many ? RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_COMPACT : RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(scene_, many ? RTC_BUILD_QUALITY_MEDIUM : RTC_BUILD_QUALITY_HIGH);
  // One thread: the order of the tree decides which of two triangles a ray through their common edge hits, and a
  // parallel build makes it depend on the number of threads.
  tbb::task_arena(1).execute([&] { rtcJoinCommitScene(scene_); });
  const RTCError error = rtcGetDeviceError(device_);
  if (error == RTC_ERROR_NONE) return;
  rtcReleaseScene(scene_);
  rtcReleaseDevice(device_);
  if (error == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
  throw std::runtime_error(fmt::format("Embree cannot build the scene (error {})", static_cast<int>(error)));
}

RayCaster::~RayCaster() {
  if (scene_ != nullptr) rtcReleaseScene(scene_);
  if (device_ != nullptr) rtcReleaseDevice(device_);
}

float RayCaster::tree_clearance(const Vec3& p, float limit) const {
  NearestQuery nearest{shapes_, limit};
  RTCPointQuery query{p.x, p.y, p.z, 0, limit};
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(scene_, &query, &context, visit_primitive, &nearest);
  // What was not visited is further away than the radius at that time, which only shrank.
  return nearest.distance < limit ? kWorthLooking * nearest.distance : limit;
}

}  // namespace turbid
