#include "integrator/technique_pilot.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/log.h"
#include "integrator/gather_pilot.h"

namespace turbid {
namespace {

constexpr uint64_t kPilotStream = 0x7465636eull;
constexpr int kFewBeamPaths = 1000, kManyBeamPaths = 8000;
/// How much more variance times work is borne for a fuller set. What the pilot never met (a caustic that lines find one
/// time in a million) is missing from its variances, and more techniques find it in more ways.
constexpr double kPriceOfFullness = 1.5;

using Techniques = std::vector<Technique>;

struct Candidate {
  UpbpSettings settings;
  Upbp::Observation seen;
  double product() const { return seen.variance * seen.work; }
};

class Pilot {
 public:
  Pilot(const Scene& scene, const PathSettings& path, const UpbpSettings& own, uint64_t seed, const StopFlag& stop)
      : scene_(scene), path_(path), own_(own), seed_(hash_counters(seed, kPilotStream)), stop_(stop) {}

  Candidate observe(const Techniques& techniques, int beam_paths) const {
    Candidate result{own_, {}};
    for (const Technique technique : techniques) result.settings.techniques.set(static_cast<size_t>(technique));
    result.settings.beam_paths = beam_paths;
    result.seen = Upbp(path_, result.settings).observe(scene_, seed_, stop_);
    return result;
  }

  /// With as many beams as are best: the variance is linear in 1/count, the work in the count, as for q in QTradeOff.
  Candidate observe_beams(const Techniques& techniques) const {
    if (own_.beam_paths > 0) return observe(techniques, own_.beam_paths);
    Candidate few = observe(techniques, kFewBeamPaths);
    const Candidate many = observe(techniques, kManyBeamPaths);
    constexpr double kLow = static_cast<double>(kFewBeamPaths) / kManyBeamPaths;
    const QTradeOff trade =
        trade_off({1, few.seen.variance, few.seen.work}, {kLow, many.seen.variance, many.seen.work});
    // No farther than between the two that were seen.
    const double share = trade.best(kLow);
    few.settings.beam_paths = static_cast<int>(std::lround(kFewBeamPaths / share));
    few.seen = {trade.variance + trade.variance_by_q * share, trade.work + trade.work_by_spheres / share};
    return few;
  }

 private:
  const Scene& scene_;
  const PathSettings& path_;
  const UpbpSettings& own_;
  uint64_t seed_;
  const StopFlag& stop_;
};

std::string names_of(const UpbpSettings& settings) {
  std::string names;
  for (size_t i = 0; i < kTechniqueNames.size(); ++i)
    if (settings.techniques[i]) names += (names.empty() ? "" : "+") + std::string(kTechniqueNames[i]);
  return names;
}

}  // namespace

size_t fullest_affordable(std::span<const double> products) {
  const double least = *std::min_element(products.begin(), products.end());
  size_t chosen = products.size() - 1;
  while (!(products[chosen] <= kPriceOfFullness * least) && chosen > 0) --chosen;
  return chosen;
}

UpbpSettings choose_techniques(const Scene& scene, const PathSettings& path, const UpbpSettings& own, uint64_t seed,
                               const StopFlag& stop) {
  using enum Technique;
  const Pilot pilot(scene, path, own, seed, stop);
  std::vector<Candidate> candidates = {pilot.observe({kJoin}, own.beam_paths),
                                       pilot.observe({kJoin, kSurface}, own.beam_paths)};
  if (!scene.media().empty()) {
    candidates.push_back(pilot.observe({kJoin, kSurface, kPointBeam}, own.beam_paths));
    candidates.push_back(pilot.observe({kJoin, kSurface, kPointPoint, kPointBeam}, own.beam_paths));
    candidates.push_back(pilot.observe_beams({kJoin, kSurface, kPointPoint, kPointBeam, kBeamBeam}));
  }
  std::vector<double> products;
  for (const Candidate& candidate : candidates) products.push_back(candidate.product());
  const double least = *std::min_element(products.begin(), products.end());
  const UpbpSettings& settings = candidates[fullest_affordable(products)].settings;
  std::string report;
  for (const Candidate& candidate : candidates)
    report += fmt::format("{}{} {:.2f}", report.empty() ? "" : ", ", names_of(candidate.settings),
                          candidate.product() / least);
  const std::string beams =
      settings.uses(kBeamBeam) ? fmt::format(", beams of {} light paths", settings.beam_paths) : "";
  log_notice(fmt::format("techniques {}{}; variance times work over the least: {}", names_of(settings), beams, report));
  return settings;
}

}  // namespace turbid
