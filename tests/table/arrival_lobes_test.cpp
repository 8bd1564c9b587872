#include "table/arrival_lobes.h"

#include <gtest/gtest.h>

#include "medium/henyey_greenstein.h"

namespace turbid {
namespace {

// What light from one direction leaves in all directions has the integral of the phase function, 1, and its peak.
TEST(ArrivalLobes, ArePhaseFunctions) {
  const LobeDirections directions;
  for (const float g : {0.0f, 0.7f}) {
    const HenyeyGreensteinPhase phase(g);
    const ArrivalLobes arrivals(phase);
    for (const Vec3& d : {Vec3(0, 0, 1), normalize(Vec3(0.3f, 0.8f, -0.2f)), normalize(Vec3(-1, 0.01f, 0.4f))}) {
      const float* lobe = arrivals.lobe(ArrivalLobes::step(d));
      double sum = 0, worst = 0;
      for (size_t k = 0; k < LobeDirections::kCount; ++k) {
        const Vec3 to(directions.x[k], directions.y[k], directions.z[k]), image(to.x, -to.y, to.z);
        sum += static_cast<double>(lobe[k] * directions.solid_angle[k]);
        const float expected = (phase.eval(dot(d, to)) + phase.eval(dot(d, image))) / 2;
        worst = std::max(worst, static_cast<double>(std::abs(lobe[k] - expected)));
      }
      EXPECT_NEAR(sum, 1, 0.01) << g;
      EXPECT_LT(worst, 0.04 * static_cast<double>(phase.eval(1))) << g;
    }
  }
}

}  // namespace
}  // namespace turbid
