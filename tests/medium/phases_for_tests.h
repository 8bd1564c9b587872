#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "medium/phase_function.h"
#include "testing/chi_square.h"

namespace turbid::testing {

struct NamedPhase {
  std::string name;
  std::shared_ptr<const PhaseFunction> phase;
  /// sample() grows with u. Not so for blends, which do within each part only, and not for Henyey-Greenstein and Draine
  /// with g < 0, which are mirrored.
  bool grows_with_u = true;
};

/// One or more of every class, with the parameters that are difficult: near isotropic, near a pole, with edges.
const std::vector<NamedPhase>& all_phase_functions();

/// int weight(theta) f(cos theta) dtheta over [0, pi]; finer towards the ends, where peaks stand.
double integrate_angles(const PhaseFunction& phase, const std::function<double(double)>& weight);
/// 2 pi int weight(mu) f(mu) dmu.
double moment(const PhaseFunction& phase, const std::function<double(double)>& weight);

/// Samples of one against the density of another, as s = sin(theta/2) = sqrt((1 - mu) / 2): a histogram that is finer
/// in the forward direction than one in mu.
ChiSquareResult test_samples(const PhaseFunction& sampled, const PhaseFunction& claimed);

}  // namespace turbid::testing
