#include "geometry/ray_caster.h"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <stdexcept>

namespace turbid {
namespace {
/// Beyond this many primitives the best hierarchy costs too much time and memory to build.
constexpr size_t kManyPrimitives = 2'000'000;

/// How much nearer than the nearest surface found so far another must be to be looked for. Surfaces at nearly the same
/// distance are many (a sphere seen from its middle), and a bound need not tell them apart.
constexpr float kWorthLooking = 0.75f;

void attach(RTCScene scene, RTCGeometry geometry, uint32_t number) {
  rtcAttachGeometryByID(scene, geometry, number);
  rtcReleaseGeometry(geometry);
}

struct NearestQuery {
  const std::vector<std::shared_ptr<const Shape>>& shapes;
  const std::map<uint32_t, PlacedTree>& placements;
  float distance;
};

/// The search for the nearest member of a placed group. Distances are the world's, the query and its radius the
/// group's.
struct MemberQuery {
  const GroupPlacement& placement;
  Vec3 local;
  float local_error;
  float distance;

  /// Radius in the group that surely reaches as far as `world` does, from wherever rounding has put `local`.
  float radius_of(float world) const {
    constexpr float kSafely = 1 + 1e-6f;
    return (world / placement.least_stretch() + local_error) * kSafely;
  }
  float world_bound(float local_distance) const {
    constexpr float kSafely = 1 - 1e-6f;
    return std::max(0.0f, (local_distance - local_error) * placement.least_stretch() * kSafely);
  }
};

bool visit_member(RTCPointQueryFunctionArguments* args) {
  auto& nearest = *static_cast<MemberQuery*>(args->userPtr);
  const Shape& member = *nearest.placement.group().members[args->geomID];
  const float distance = nearest.world_bound(member.distance_bound(nearest.local, args->primID));
  if (!(distance < nearest.distance)) return false;
  nearest.distance = distance;
  args->query->radius = nearest.radius_of(kWorthLooking * distance);
  return true;
}

/// A bound on the distance to a placed group's members: below `distance`, or what that was.
float nearest_member(const PlacedTree& tree, const Vec3& p, float distance, float radius) {
  const Vec3 local = tree.placement->local_point(p);
  MemberQuery nearest{*tree.placement, local, tree.placement->local_error(local), distance};
  RTCPointQuery query{local.x, local.y, local.z, 0, nearest.radius_of(radius)};
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(tree.members, &query, &context, visit_member, &nearest);
  return nearest.distance;
}

bool visit_primitive(RTCPointQueryFunctionArguments* args) {
  auto& nearest = *static_cast<NearestQuery*>(args->userPtr);
  const Vec3 p(args->query->x, args->query->y, args->query->z);
  const auto tree = nearest.placements.empty() ? nearest.placements.end() : nearest.placements.find(args->geomID);
  const float distance = tree == nearest.placements.end()
                             ? nearest.shapes[args->geomID]->distance_bound(p, args->primID)
                             : nearest_member(tree->second, p, nearest.distance, args->query->radius);
  if (!(distance < nearest.distance)) return false;
  nearest.distance = distance;
  args->query->radius = kWorthLooking * distance;
  return true;
}
}  // namespace

RayCaster::RayCaster(std::vector<std::shared_ptr<const Shape>> shapes) : shapes_(std::move(shapes)) {
  try {
    build();
  } catch (...) {
    release();
    throw;
  }
}

RayCaster::~RayCaster() { release(); }

void RayCaster::release() {
  if (scene_ != nullptr) rtcReleaseScene(scene_);
  for (const auto& [group, scene] : groups_) rtcReleaseScene(scene);
  if (device_ != nullptr) rtcReleaseDevice(device_);
}

void RayCaster::build() {
  std::vector<uint32_t> spheres, others;
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
  size_t primitives = 0;
  for (const uint32_t i : others) {
    const auto* instance = dynamic_cast<const ShapeInstance*>(shapes_[i].get());
    if (instance != nullptr && instance->member_index() > 0) continue;  // attached with the first member
    if (instance != nullptr) {
      attach_placement(i);
      ++primitives;
    } else {
      primitives += shapes_[i]->primitive_count();
      attach(scene_, shapes_[i]->make_embree_geometry(device_), i);
    }
  }
  commit(scene_, primitives);
}

void RayCaster::attach_placement(uint32_t first) {
  const GroupPlacement& placement = static_cast<const ShapeInstance&>(*shapes_[first]).placement();
  const std::vector<std::shared_ptr<const Shape>>& members = placement.group().members;
  for (uint32_t i = 1; i < members.size(); ++i) {
    const auto* next =
        first + i < shapes_.size() ? dynamic_cast<const ShapeInstance*>(shapes_[first + i].get()) : nullptr;
    if (next == nullptr || &next->placement() != &placement || next->member_index() != i)
      throw std::invalid_argument("the members of a placed group must stand side by side");
  }
  RTCScene& tree = groups_[&placement.group()];
  if (tree == nullptr) {
    tree = rtcNewScene(device_);
    size_t primitives = 0;
    for (uint32_t i = 0; i < members.size(); ++i) {
      primitives += members[i]->primitive_count();
      attach(tree, members[i]->make_embree_geometry(device_), i);
    }
    commit(tree, primitives);
  }
  const PlacedTree& placed = placements_.emplace(first, PlacedTree{&placement, tree}).first->second;
  attach(scene_, placed.make_embree_geometry(device_), first);
}

void RayCaster::commit(RTCScene scene, size_t primitives) const {
  const bool many = primitives > kManyPrimitives;
  // Robust: watertight along shared edges, and no bounding box is missed by rounding.
  rtcSetSceneFlags(scene, many ? RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_COMPACT : RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(scene, many ? RTC_BUILD_QUALITY_MEDIUM : RTC_BUILD_QUALITY_HIGH);
  // One thread: the order of the tree decides which of two triangles a ray through their common edge hits, and a
  // parallel build makes it depend on the number of threads.
  tbb::task_arena(1).execute([&] { rtcJoinCommitScene(scene); });
  const RTCError error = rtcGetDeviceError(device_);
  if (error == RTC_ERROR_NONE) return;
  if (error == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
  throw std::runtime_error(fmt::format("Embree cannot build the scene (error {})", static_cast<int>(error)));
}

Hit RayCaster::placed(const Hit& local, uint32_t first_member) const {
  Hit hit = local;
  hit.shape += first_member;
  hit.ng = static_cast<const ShapeInstance&>(*shapes_[hit.shape]).placement().to_world().normal(local.ng);
  return hit;
}

bool RayCaster::has_cheap_clearance(uint32_t index) const {
  return std::any_of(spheres_.begin(), spheres_.end(), [&](const LoneSphere& lone) { return lone.shape == index; });
}

float RayCaster::tree_clearance(const Vec3& p, float limit) const {
  NearestQuery nearest{shapes_, placements_, limit};
  RTCPointQuery query{p.x, p.y, p.z, 0, limit};
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(scene_, &query, &context, visit_primitive, &nearest);
  // What was not visited is further away than the radius at that time, which only shrank.
  return nearest.distance < limit ? kWorthLooking * nearest.distance : limit;
}

}  // namespace turbid
