#include "experiment/relations.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "experiment/results_page.h"

namespace turbid {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

std::string cell(const AgainstBaseline& against) {
  if (!against.factor) return "not reached";
  // One that is as unsure as it is large says nothing.
  const bool known = against.factor->value > against.factor->error;
  std::string text = known ? with_error(*against.factor) + " ×" : "not known";
  if (against.is_lost_in_reference)
    text += known ? " (about: below the reference's error)" : " (below the reference's error)";
  // A factor says nothing of light that is missing.
  constexpr double kMuch = 0.05;
  if (std::abs(against.mean_ratio - 1) > kMuch) text += fmt::format(", mean {:.2f}", against.mean_ratio);
  return text;
}

}  // namespace

std::vector<PairDifference> differences_of(const ExperimentResult& result) {
  std::vector<PairDifference> all;
  for (const SceneResult& scene : result.scenes)
    for (const MethodPair& pair : result.experiment.pairs) {
      const MethodResult &method = scene.method(pair.method), &against = scene.method(pair.against);
      const ImageMetrics metrics =
          compare_images(color_channels(method.image, pair.method), color_channels(against.image, pair.against));
      all.push_back({.scene = scene.scene.name,
                     .pair = pair,
                     .rmse = metrics.rmse,
                     .psnr = 20 * std::log10(scene.reference.error.peak / metrics.rmse),
                     .mean_ratio = metrics.mean_ratio,
                     .equal_samples = method.runs.front().back().samples == against.runs.front().back().samples});
    }
  return all;
}

std::vector<AgainstBaseline> against_baseline(const ExperimentResult& result) {
  std::vector<AgainstBaseline> all;
  if (result.experiment.baseline.empty()) return all;
  for (const SceneResult& scene : result.scenes) {
    const auto base = merit(scene.method(result.experiment.baseline).score, result.rule.equal);
    for (const MethodResult& made : scene.methods) {
      if (made.method.name == result.experiment.baseline) continue;
      AgainstBaseline& against = all.emplace_back(AgainstBaseline{scene.scene.name, made.method.name});
      const auto own = merit(made.score, result.rule.equal);
      if (base && own) against.factor = ratio_of(*base, *own);
      against.is_lost_in_reference = made.score.is_lost_in_reference;
      against.mean_ratio = made.score.mean_ratio.value;
    }
  }
  return all;
}

ReportTable baseline_table(const ExperimentResult& result) {
  const bool by_samples = result.rule.equal == EqualBy::kSamples;
  const std::string& baseline = result.experiment.baseline;
  ReportTable table{.title = by_samples ? fmt::format("Against {}: how many times as large its error is", baseline)
                                        : fmt::format("Against {}: how many times as long it needs for the same error "
                                                      "(above 1: the method is ahead)",
                                                      baseline),
                    .columns = {"method"},
                    .rows = {}};
  for (const SceneResult& scene : result.scenes) table.columns.push_back(scene.scene.name);
  const std::vector<AgainstBaseline> all = against_baseline(result);
  for (const ExperimentMethod& method : result.experiment.methods) {
    if (method.name == result.experiment.baseline) continue;
    std::vector<ReportTable::Cell> row = {method.name};
    for (const AgainstBaseline& against : all)
      if (against.method == method.name) row.emplace_back(cell(against));
    table.rows.push_back(std::move(row));
  }
  return table;
}

ReportTable pairs_table(const ExperimentResult& result) {
  ReportTable table{.title = "Pictures of the first seed against each other: noise that they have in common falls out",
                    .columns = {"scene", "method", "against", "RMSE", "PSNR, dB", "mean ratio", ""},
                    .rows = {}};
  for (const PairDifference& d : differences_of(result))
    table.rows.push_back({d.scene, d.pair.method, d.pair.against, d.rmse, fmt::format("{:.1f}", d.psnr), d.mean_ratio,
                          d.equal_samples ? "" : "not of the same samples: one ran out of time"});
  return table;
}

Json baseline_json(const ExperimentResult& result) {
  Json all = Json::array();
  for (const AgainstBaseline& a : against_baseline(result))
    all.push_back({{"scene", a.scene},
                   {"method", a.method},
                   {"factor", a.factor ? Json{{"value", number(a.factor->value)}, {"error", number(a.factor->error)}}
                                       : Json(nullptr)},
                   {"lost_in_reference", a.is_lost_in_reference}});
  return all;
}

Json pairs_json(const ExperimentResult& result) {
  Json all = Json::array();
  for (const PairDifference& d : differences_of(result))
    all.push_back({{"scene", d.scene},
                   {"method", d.pair.method},
                   {"against", d.pair.against},
                   {"rmse", number(d.rmse)},
                   {"psnr", number(d.psnr)},
                   {"mean_ratio", number(d.mean_ratio)},
                   {"equal_samples", d.equal_samples}});
  return all;
}

}  // namespace turbid
