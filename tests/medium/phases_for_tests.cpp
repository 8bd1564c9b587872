#include "medium/phases_for_tests.h"

#include <array>
#include <cmath>
#include <numbers>

#include "medium/blend_phase.h"
#include "medium/draine.h"
#include "medium/fournier_forand.h"
#include "medium/half_henyey_greenstein.h"
#include "medium/henyey_greenstein.h"
#include "medium/isotropic.h"
#include "medium/mie.h"
#include "medium/mie_fit.h"
#include "medium/rayleigh.h"
#include "medium/tabulated_phase.h"
#include "medium/two_term_henyey_greenstein.h"

namespace turbid::testing {
namespace {

std::vector<NamedPhase> make_all() {
  std::vector<NamedPhase> result{{"isotropic", std::make_shared<IsotropicPhase>()},
                                 {"rayleigh", std::make_shared<RayleighPhase>()}};
  for (const float g :
       {-0.999f, -0.99f, -0.9f, -0.5f, -1e-3f, -1e-6f, 0.0f, 1e-7f, 1e-4f, 0.01f, 0.3f, 0.7f, 0.9f, 0.99f, 0.999f})
    result.push_back({"hg " + std::to_string(g), std::make_shared<HenyeyGreensteinPhase>(g), g >= 0});
  result.push_back({"blend",
                    std::make_shared<BlendPhase>(std::make_shared<HenyeyGreensteinPhase>(0.8f),
                                                 std::make_shared<HenyeyGreensteinPhase>(-0.3f), 0.25f),
                    false});
  result.push_back({"table of 2", std::make_shared<TabulatedPhase>(std::array{0.0f, 3.0f})});
  result.push_back({"table", std::make_shared<TabulatedPhase>(std::array{2.0f, 0.5f, 0.0f, 0.0f, 1.0f, 6.0f})});

  for (const std::string& preset : two_term_presets())
    result.push_back({preset, std::make_shared<TwoTermHenyeyGreensteinPhase>(two_term_preset(preset)), false});
  for (const float g : {-0.99f, -0.5f, -1e-3f, 0.0f, 1e-4f, 0.5f, 0.95f, 0.999f}) {
    using Half = HalfHenyeyGreensteinPhase;
    result.push_back({"forward_hg " + std::to_string(g), std::make_shared<Half>(g, Half::Hemisphere::kForward)});
    result.push_back({"backward_hg " + std::to_string(g), std::make_shared<Half>(g, Half::Hemisphere::kBackward)});
  }
  for (const auto& [g, alpha] : {std::pair{0.0f, 1.0f}, {-0.6f, 3.0f}, {1e-5f, 250.0f}, {0.55f, 22.0f}, {0.98f, 1.0f}})
    result.push_back({"draine " + std::to_string(g), std::make_shared<DrainePhase>(g, alpha), g >= 0});
  for (const float diameter : {0.08f, 0.7f, 3.0f, 10.0f, 50.0f})
    result.push_back({"mie_fit " + std::to_string(diameter), std::make_shared<MieFitPhase>(diameter), false});
  for (const auto& [n, slope] : {std::pair{1.10, 3.5835}, {1.021, 3.0742}, {1.15, 4.874}})
    result.push_back({"fournier_forand " + std::to_string(n),
                      std::make_shared<FournierForandPhase>(FournierForandPhase::Parameters{n, slope})});
  for (const auto& [radius, deviation] : {std::pair{0.02, 0.0}, {0.5, 0.0}, {5.0, 0.1}, {20.0, 0.0}})
    result.push_back({"mie " + std::to_string(radius),
                      std::make_shared<MiePhase>(MiePhase::Parameters{.radius = radius, .deviation = deviation})});
  return result;
}

}  // namespace

const std::vector<NamedPhase>& all_phase_functions() {
  static const std::vector<NamedPhase> all = make_all();
  return all;
}

double integrate_angles(const PhaseFunction& phase, const std::function<double(double)>& weight) {
  const auto integrand = [&](double theta) {
    return weight(theta) * static_cast<double>(phase.eval_angle(static_cast<float>(theta)));
  };
  const double middle = std::numbers::pi / 2;
  double sum = 0;
  for (double outer = middle; outer > 0;) {
    const double inner = outer > 1e-6 ? outer / 2 : 0;
    sum += integrate_interval(integrand, inner, outer, 1e-8, 4, 12);
    sum += integrate_interval(integrand, 2 * middle - outer, 2 * middle - inner, 1e-8, 4, 12);
    outer = inner;
  }
  return sum;
}

double moment(const PhaseFunction& phase, const std::function<double(double)>& weight) {
  return 2 * std::numbers::pi *
         integrate_angles(phase, [&](double theta) { return weight(std::cos(theta)) * std::sin(theta); });
}

ChiSquareResult test_samples(const PhaseFunction& sampled, const PhaseFunction& claimed) {
  return chi_square_interval(
      [&](Rng& rng) -> std::optional<double> {
        return std::sqrt((1 - static_cast<double>(sampled.sample(rng.next_float()))) / 2);
      },
      [&](double s) {  // dOmega = 2 pi dmu, mu = 1 - 2 s^2
        return 8 * std::numbers::pi * s *
               static_cast<double>(claimed.eval_angle(static_cast<float>(2 * std::asin(std::min(s, 1.0)))));
      },
      0, 1);
}

}  // namespace turbid::testing
