#include "gathering/volume_index.h"

#include <fmt/format.h>

#include <stdexcept>

#include "geometry/user_geometry.h"

namespace turbid {
namespace {

void check(RTCDevice device) {
  const RTCError error = rtcGetDeviceError(device);
  if (error == RTC_ERROR_NONE) return;
  if (error == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
  throw std::runtime_error(fmt::format("Embree cannot index the volumes (error {})", static_cast<int>(error)));
}

}  // namespace

VolumeIndex::VolumeIndex() : device_(rtcNewDevice(nullptr)) {
  if (device_ == nullptr) check(nullptr);
}

VolumeIndex::~VolumeIndex() {
  if (scene_) rtcReleaseScene(scene_);
  rtcReleaseDevice(device_);
}

void VolumeIndex::build(size_t count, const std::function<Bounds3(size_t)>& box) {
  if (scene_) rtcReleaseScene(scene_);
  scene_ = nullptr;
  count_ = count;
  if (empty()) return;
  scene_ = rtcNewScene(device_);
  RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(count));
  rtcSetGeometryUserData(geometry, const_cast<std::function<Bounds3(size_t)>*>(&box));  // only read, and only below
  rtcSetGeometryBoundsFunction(
      geometry,
      [](const RTCBoundsFunctionArguments* args) {
        const Bounds3 b =
            widened((*static_cast<const std::function<Bounds3(size_t)>*>(args->geometryUserPtr))(args->primID));
        *args->bounds_o = {b.min.x, b.min.y, b.min.z, 0, b.max.x, b.max.y, b.max.z, 0};
      },
      nullptr);
  rtcSetGeometryOccludedFunction(geometry, [](const RTCOccludedFunctionNArguments* args) {
    const auto* query = reinterpret_cast<const Query*>(args->context);
    query->call(query->visit, args->primID);
  });
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_, geometry);
  rtcReleaseGeometry(geometry);
  // Robust: rounding misses no box, so that what is found does not depend on the shape of the tree, and it may be
  // built by any number of threads.
  rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_MEDIUM);
  rtcJoinCommitScene(scene_);
  rtcSetGeometryUserData(rtcGetGeometry(scene_, 0), nullptr);
  check(device_);
}

}  // namespace turbid
