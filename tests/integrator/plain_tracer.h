#pragma once
#include "integrator/sampling_integrator.h"

namespace turbid::testing {

/// The plain twin of `volpath`: finds lights only by meeting them, casts a ray for every flight, knows nothing of blind
/// or dense media, and weighs the channels over the whole path: one channel is picked per path, densities are kept for
/// all, and the contribution is f / mean_c(pdf_c). Slow, short, and built differently where the fast one is clever.
class PlainTracer : public SamplingIntegrator {
 public:
  explicit PlainTracer(int max_depth = 1 << 20) : max_depth_(max_depth) {}

 protected:
  PixelSample sample_radiance(const Scene& scene, const SensorRay& camera, Sampler& sampler,
                              SampleCounters& counters) const override;

 private:
  int max_depth_;
};

}  // namespace turbid::testing
