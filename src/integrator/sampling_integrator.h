#pragma once
#include <mutex>

#include "integrator/integrator.h"
#include "path/sample_counters.h"

namespace turbid {

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

  /// Counts what happened outside of samples, too: from any thread.
  void add_counters(const SampleCounters& counters);

 private:
  void render_tile(const Scene& scene, const Pass& pass, const Vec2i& from, const Vec2i& to, Film& film,
                   SampleCounters& counters, const StopFlag& stop) const;
  void report_bad_sample(const PixelSample& sample, const Vec2i& pixel, const Pass& pass, uint64_t index) const;

  std::vector<OrderLayer> order_layers_;
  mutable std::mutex mutex_;
  SampleCounters totals_;
};

}  // namespace turbid
