#include "integrator/boundary_views.h"

#include "core/frame.h"
#include "core/parallel.h"

namespace turbid {
namespace {

/// Looks into a medium, as far as the first collision of one visit.
class View : public WalkRecorder {
 public:
  View(const Medium& medium, const Prediction& prediction, Rng& rng)
      : medium_(medium), prediction_(prediction), rng_(rng) {}

  void begin() { done_ = false; }
  void at_collision(const CollisionEvent& event, const PathState& state, const Traveller&) {
    done_ = true;
    if (&event.medium == &medium_) seen.push_back({event.position, -event.direction, prediction_(event, state, rng_)});
  }
  void left_surface(const SurfaceEvent& event, const BsdfSample& sample, const Vec3&, const PathState&,
                    const Traveller& traveller) {
    const bool ends_visit = sample.flags & lobe::kReflection && !keeps_visit(*event.object.bsdf);
    done_ |= ends_visit || traveller.medium() != &medium_;
  }
  bool goes_on() const { return !done_; }

  std::vector<LeavingPower> seen;

 private:
  const Medium& medium_;
  const Prediction& prediction_;
  Rng& rng_;
  bool done_ = false;
};

Ray random_line(const Ball& ball, Rng& rng) {
  const float z = 2 * rng.next_float() - 1, ring = safe_sqrt(1 - z * z), phi = 2 * kPi * rng.next_float();
  const Vec3 direction{ring * std::cos(phi), ring * std::sin(phi), z};
  const Vec2 u{rng.next_float(), rng.next_float()};
  return {start_from_infinity(ball.center, ball.radius, direction, u), direction, 2 * ball.radius};
}

struct Inside {
  const Medium* medium = nullptr;
  MediumStack enclosing = MediumStack();
};
Inside inside_of(const Scene& scene, const Vec3& p) {
  if (!scene.has_priorities()) return {scene.medium_at(p), MediumStack()};
  const MediumStack enclosing = scene.media_at(p);
  return {enclosing.medium(), enclosing};
}

}  // namespace

std::vector<LeavingPower> look_into(const Scene& scene, const Medium& medium, const std::set<SurfaceSide>& sides,
                                    const Ball& ball, size_t lines, uint64_t seed, const Prediction& prediction) {
  constexpr size_t kGrain = 256;  // lines per task
  const PathSettings all_paths;
  // All lines in all directions, over how many there are.
  const float measure = 4 * kPi * kPi * sqr(ball.radius) / static_cast<float>(lines);
  std::vector<std::vector<LeavingPower>> parts((lines + kGrain - 1) / kGrain);
  parallel_for(parts.size(), [&](size_t task) {
    SampleCounters counters;
    Rng rng(hash_counters(seed, task));
    Sampler sampler(scene.sampler(), seed);
    View view(medium, prediction, rng);
    CameraWalk<View> walk(scene, all_paths, sampler, counters, view);
    for (size_t i = task * kGrain; i < std::min(lines, (task + 1) * kGrain); ++i) {
      sampler.start(i, 0);
      Ray line = random_line(ball, rng);
      while (const Hit hit = scene.rays().intersect(line)) {
        const Object& object = scene.object(hit);
        const SurfacePoint point = object.shape->surface_point(line, hit);
        const Vec3 before = point.leave(-line.direction), behind = point.leave(line.direction);
        const SurfaceSide side{&object, dot(line.direction, point.ng) > 0};
        const Inside there = sides.contains(side) ? inside_of(scene, behind) : Inside{};
        if (there.medium == &medium) {
          const bool opaque = !(object.bsdf->flags() & lobe::kTransmission);
          const Inside here = opaque ? there : inside_of(scene, before);
          view.begin();
          if (opaque || here.medium != &medium)
            walk.run({{opaque ? behind : before, line.direction}}, here.medium, here.enclosing);
        }
        line = {behind, line.direction, line.t_max - hit.t};
        if (!(line.t_max > 0)) break;
      }
    }
    for (LeavingPower& power : view.seen) power.power *= measure;
    parts[task] = std::move(view.seen);
  });
  std::vector<LeavingPower> all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace turbid
