// The agreement matrix: every pair of integrators on every scene of the suite, in whole and by scattering order, at
// length. Writes agreement.md into the folder that the test runs in.
#include "integrator/agreement.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>

#include "integrator/suite.h"

namespace turbid::testing {
namespace {

const std::vector<Contestant> kContestants = {{"volpath", 640, 1, 1}, {"ptracer", 640, 1, 2}, {"bdpt", 320, 1, 3}};

std::string cell(const Agreement& agreement, size_t comparisons) {
  if (!agreement.cannot.empty()) return agreement.cannot;
  std::string text;
  static const char* const kNames[] = {"", "0: ", "1: ", "2: ", "3+: "};
  for (size_t k = 0; k < agreement.verdicts.size(); ++k)
    if (agreement.verdicts[k])
      text += fmt::format("{}{}{:.4f} ± {:.4f}", text.empty() ? "" : "<br>", kNames[k], agreement.mean_ratio[k],
                          agreement.ratio_error[k]);
  return text +
         fmt::format("<br>p {:.2g}{}", agreement.smallest_p(), agreement.accepted(comparisons) ? "" : " **differ**");
}

TEST(SlowAgreement, Matrix) {
  const std::vector<SuiteScene> scenes = suite();
  const size_t comparisons = scenes.size() * kContestants.size() * (kContestants.size() - 1) / 2;
  std::ofstream page("agreement.md");
  page << "| scene |";
  for (size_t i = 0; i < kContestants.size(); ++i)
    for (size_t k = i + 1; k < kContestants.size(); ++k)
      page << fmt::format(" {} / {} |", kContestants[k].integrator, kContestants[i].integrator);
  page << "\n| --- | --- | --- | --- |\n";
  for (const SuiteScene& scene : scenes) {
    std::vector<Observation> observations;
    for (Contestant contestant : kContestants) {
      contestant.samples *= scene.effort;
      observations.push_back(observe(scene.xml, contestant, scene.block));
    }
    page << "| " << scene.name << " |";
    for (size_t i = 0; i < kContestants.size(); ++i)
      for (size_t k = i + 1; k < kContestants.size(); ++k) {
        std::string text;
        for (const size_t one : {i, k})
          if (!scene.has_variance(kContestants[one].integrator))
            text = kContestants[one].integrator + " has no variance here";
        if (text.empty()) {
          const Agreement agreement = compare(observations[i], observations[k]);
          EXPECT_TRUE(agreement.accepted(comparisons))
              << scene.name << ": " << kContestants[i].integrator << " against " << kContestants[k].integrator << "\n"
              << agreement.report();
          text = cell(agreement, comparisons);
        }
        page << " " << text << " |";
      }
    page << std::endl;
  }
}

}  // namespace
}  // namespace turbid::testing
