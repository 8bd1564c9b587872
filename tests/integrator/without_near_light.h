#pragma once
#include "integrator/light_gatherer.h"
#include "integrator/sampling_integrator.h"

namespace turbid::testing {

/// `volpath` without the light that virtual lights leave out when told a least distance: let x be a vertex that leaves
/// a choice of direction and has none such before it but specular ones in between, y its neighbour towards the light
/// with a choice of direction, too; paths whose line from x to y is shorter do not count.
class WithoutNearLight : public SamplingIntegrator {
 public:
  WithoutNearLight(const PathSettings& settings, float least_distance)
      : settings_(settings), least_distance_(least_distance) {}

 protected:
  PixelSample sample_radiance(const Scene& scene, const SensorRay& camera, Sampler& sampler,
                              SampleCounters& counters) const override {
    Gatherer gatherer(scene, *this, sampler, counters);
    CameraWalk<Gatherer> walk(scene, settings_, sampler, counters, gatherer);
    const float alpha = walk.run(camera);
    PixelSample sample = gatherer.result();
    sample.alpha = alpha;
    return sample;
  }

 private:
  class Gatherer : public LightGatherer {
   public:
    Gatherer(const Scene& scene, const WithoutNearLight& owner, Sampler& sampler, SampleCounters& counters)
        : LightGatherer(scene, owner.settings_, {}, nullptr, sampler, counters),
          least_distance_(owner.least_distance_) {}

    void at_collision(const CollisionEvent& event, const PathState& state, const Traveller& traveller) {
      if (counts(event.position)) LightGatherer::at_collision(event, state, traveller);
    }
    void at_surface(const SurfaceEvent& event, const PathState& state, const Traveller& traveller) {
      if (!(event.object.bsdf->flags() & lobe::kSmooth)) return;
      if (counts(event.point.p)) LightGatherer::at_surface(event, state, traveller);
    }
    void left_collision(const CollisionEvent& event, float mu, const Vec3& chosen, const PathState& state,
                        const Traveller& traveller) {
      LightGatherer::left_collision(event, mu, chosen, state, traveller);
      leave(event.position);
    }
    void left_surface(const SurfaceEvent& event, const BsdfSample& sample, const Vec3& chosen, const PathState& state,
                      const Traveller& traveller) {
      LightGatherer::left_surface(event, sample, chosen, state, traveller);
      if (sample.flags & lobe::kDelta)
        open_ = false;
      else
        leave(event.point.p);
    }
    bool goes_on() const { return !ended_; }

   private:
    bool counts(const Vec3& p) {
      if (open_ && !beyond_y_ && length(p - x_) < least_distance_) ended_ = true;
      return !ended_;
    }
    void leave(const Vec3& p) {
      beyond_y_ = beyond_y_ || open_;
      open_ = true;
      x_ = p;
    }

    float least_distance_;
    Vec3 x_{0};
    bool open_ = false, beyond_y_ = false, ended_ = false;
  };

  PathSettings settings_;
  float least_distance_;
};

}  // namespace turbid::testing
