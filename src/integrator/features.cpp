#include "integrator/features.h"

#include "path/passage.h"

namespace turbid {
namespace {

constexpr int kMostSurfaces = 64;  ///< passed, before a ray counts as one that meets nothing

/// The way of one sensor ray.
class FeatureWalk {
 public:
  FeatureWalk(const Scene& scene, bool media, Sampler& sampler)
      : scene_(scene), sampler_(sampler), sees_media_(media), stacked_(media && scene.has_priorities()) {}

  Features run(const SensorRay& camera) {
    ray_ = camera.ray;
    if (stacked_) media_ = scene_.sensor_media();
    if (sees_media_) medium_ = scene_.sensor_medium();
    if (camera.near_t > 0) {  // as in the path tracer, near_clip hides surfaces and collisions, not attenuation
      if (medium_) throughput_ *= medium_->transmittance({ray_.origin, ray_.direction, camera.near_t}, sampler_);
      ray_ = {ray_.at(camera.near_t), ray_.direction, ray_.t_max - camera.near_t};
      depth_ = camera.near_t;
    }
    for (int passed = 0; passed < kMostSurfaces && !throughput_.is_black(); ++passed) {
      const Hit hit = scene_.rays().intersect(ray_);
      if (medium_ && collides(hit)) return features_;
      if (!hit || arrive(hit)) return features_;
    }
    return {};
  }

 private:
  /// Flies through the medium up to the surface; true: light scatters before.
  bool collides(const Hit& hit) {
    const float end = hit ? hit.t : std::min(ray_.t_max, scene_.distance_to_world_end(ray_));
    const Flight flight =
        medium_->sample_flight({ray_.origin, ray_.direction, end}, channel_mix(throughput_), sampler_);
    throughput_ *= flight.weight;
    if (!flight.collides) return false;
    features_.albedo = throughput_;
    features_.depth = depth_ + flight.t;
    features_.position = ray_.at(flight.t);
    return true;
  }

  /// True: the way ends here.
  bool arrive(const Hit& hit) {
    const Object& object = scene_.object(hit);
    const SurfacePoint point = object.shape->surface_point(ray_, hit);
    depth_ += hit.t;
    if (stacked_ && media_.hides(object)) return go_on(object, point, ray_.direction, ray_.t_max - hit.t);
    const Vec3 wo = point.to_local(-ray_.direction);
    const auto sample =
        object.bsdf->sample(point, wo, sampler_.next_1d(), sampler_.next_2d(), TransportMode::kRadiance);
    const lobe::Flags flags = object.bsdf->flags();
    if (sample && (sample->flags & lobe::kNull)) {
      throughput_ *= sample->weight;
      return go_on(object, point, ray_.direction, ray_.t_max - hit.t);
    }
    if (flags & lobe::kSmooth) {
      // Of a mask the sampling has left only what covers; its albedo speaks of both.
      const float covered = flags & lobe::kNull ? 1 - object.bsdf->null_transmission(point, wo).mean() : 1;
      stop(hit, point, covered > 0 ? object.bsdf->albedo(point) / covered : Spectrum(0.0f));
      return true;
    }
    if (!sample) {
      stop(hit, point, Spectrum(0.0f));
      return true;
    }
    throughput_ *= sample->weight;
    return go_on(object, point, point.to_world(sample->direction), kInfinity);
  }

  bool go_on(const Object& object, const SurfacePoint& point, const Vec3& direction, float t_max) {
    if (stacked_) {
      media_.cross(object, point.ng, -ray_.direction, direction);
      medium_ = media_.medium();
    } else if (sees_media_ && object.bounds_media) {
      medium_ = object.medium_towards(point.ng, direction);
    }
    ray_ = {point.leave(direction), direction, t_max};
    return false;
  }

  void stop(const Hit& hit, const SurfacePoint& point, const Spectrum& albedo) {
    features_ = {.albedo = throughput_ * albedo,
                 .depth = depth_,
                 .position = point.p,
                 .geometric_normal = point.ng,
                 .shading_normal = point.shading.n,
                 .uv = point.uv,
                 .dp_du = point.dp_du,
                 .dp_dv = point.dp_dv,
                 .primitive = hit.primitive,
                 .shape = hit.shape};
  }

  const Scene& scene_;
  Sampler& sampler_;
  const bool sees_media_, stacked_;
  Ray ray_;
  Spectrum throughput_{1.0f};
  float depth_ = 0;
  const Medium* medium_ = nullptr;
  MediumStack media_;
  Features features_;
};

}  // namespace

Features find_features(const Scene& scene, const SensorRay& camera, bool media, Sampler& sampler) {
  return FeatureWalk(scene, media, sampler).run(camera);
}

}  // namespace turbid
