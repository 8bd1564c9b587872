#pragma once
#include <mutex>

#include "integrator/integrator.h"

namespace turbid {

/// Counts of one tile of one pass; added to the integrator's totals when the tile is done.
struct SampleCounters {
  uint64_t camera_samples = 0;
  uint64_t rays = 0;             ///< nearest-hit casts
  uint64_t shadow_rays = 0;      ///< casts towards lights, one for each surface passed
  uint64_t collisions = 0;       ///< in media
  uint64_t free_flights = 0;     ///< collisions that needed no cast, inside a ball known to be empty
  uint64_t dropped_samples = 0;  ///< not finite or negative

  void add(const SampleCounters& other);
};

/// An integrator that estimates every pixel sample on its own, as the radiance along one sensor ray.
class SamplingIntegrator : public Integrator {
 public:
  bool render_pass(const Scene& scene, const Pass& pass, Film& film, const StopFlag& stop) override;
  Counters counters() const override;
  bool split_orders(const std::vector<OrderLayer>& layers) override;

 protected:
  /// An estimate of the radiance that arrives along the sensor ray.
  virtual PixelSample sample_radiance(const Scene& scene, const SensorRay& camera, Sampler& sampler,
                                      SampleCounters& counters) const = 0;

 private:
  void render_tile(const Scene& scene, const Pass& pass, const Vec2i& from, const Vec2i& to, Film& film,
                   SampleCounters& counters, const StopFlag& stop) const;
  void report_bad_sample(const PixelSample& sample, const Vec2i& pixel, const Pass& pass, uint64_t index) const;

  std::vector<OrderLayer> order_layers_;
  mutable std::mutex mutex_;
  SampleCounters totals_;
};

}  // namespace turbid
