#include "experiment/results_page.h"

#include <fmt/format.h>

#include <cmath>

#include "experiment/glossary.h"
#include "experiment/relations.h"
#include "experiment/results.h"
#include "render/progress.h"

namespace turbid {
namespace {

/// Standard errors from the mean to the edge of a band of confidence of 95 %.
constexpr double kBand = 1.96;

const char* unit_of(EqualBy rule) {
  switch (rule) {
    case EqualBy::kTime:
      return "least squared error × time";
    case EqualBy::kSamples:
      return "least error";
    default:
      return "first at the error asked for";
  }
}

std::string times(double factor) { return fmt::format("{:.{}f} ×", factor, factor < 9.95 ? 1 : 0); }

std::string describe(const ComparisonRule& rule) {
  const std::string seconds = format_duration(rule.seconds);
  switch (rule.equal) {
    case EqualBy::kTime:
      return fmt::format("equal time: {} of processor time each", seconds);
    case EqualBy::kSamples:
      return fmt::format("equal samples: {} per pixel, at most {} of processor time", rule.samples, seconds);
    default:
      return fmt::format("equal error: RMSE {:.3g} of the mean, at most {} of processor time", rule.error, seconds);
  }
}

ReportGroup group_of(const SceneResult& scene, EqualBy rule) {
  ReportGroup group{.title = scene.scene.name, .images = {}, .exposure = scene.scene.exposure};
  for (const MethodResult* made : ranked(scene, rule)) {
    const MethodScore& s = made->score;
    ImageMetrics metrics;
    metrics.rmse = s.rmse.value;
    metrics.peak = scene.reference.error.peak;
    metrics.psnr = s.psnr.value;
    metrics.rel_mse = s.rel_mse.value;
    metrics.mean_ratio = s.mean_ratio.value;
    group.images.push_back({.name = made->method.name,
                            .image = made->image,
                            .metrics = metrics,
                            .errors = MetricErrors{.rmse = s.rmse.error,
                                                   .psnr = s.psnr.error,
                                                   .rel_mse = s.rel_mse.error,
                                                   .mean_ratio = s.mean_ratio.error,
                                                   .cost = s.cost.error},
                            .cost = s.cost.value,
                            .seconds = s.seconds.value,
                            .samples = s.samples.value});
  }
  group.images.push_back({.name = "reference", .image = scene.reference.image, .is_reference = true});
  return group;
}

ReportPlot plot_of(const SceneResult& scene) {
  ReportPlot plot{.title = scene.scene.name + ": error against time, with bands of 95 % confidence",
                  .x_label = "processor time, s",
                  .y_label = "RMSE",
                  .series = {}};
  for (const MethodResult& made : scene.methods) {
    ReportPlot::Series series{.name = made.method.name, .x = {}, .y = {}};
    for (const ScorePoint& p : made.score.curve) {
      if (!(p.rmse.value > 0)) continue;
      series.x.push_back(p.seconds.value);
      series.y.push_back(p.rmse.value);
      // Logarithmic axes have no room for 0 and below.
      series.low.push_back(std::max(p.rmse.value - kBand * p.rmse.error, p.rmse.value / 10));
      series.high.push_back(p.rmse.value + kBand * p.rmse.error);
    }
    plot.series.push_back(std::move(series));
  }
  return plot;
}

ReportTable numbers_of(const SceneResult& scene, EqualBy rule) {
  ReportTable table{.title = scene.scene.name + ": numbers, over the seeds",
                    .columns = {"method", "RMSE", "RMSE / mean", "PSNR, dB", "relMSE", "RMSE² × time", "over the best",
                                "mean / reference", "samples", "time, s", "wall time, s", "slope"},
                    .rows = {}};
  if (rule == EqualBy::kError) table.columns.insert(table.columns.begin() + 1, "time to the error, s");
  const auto order = ranked(scene, rule);
  const auto best = merit(order.front()->score, rule);
  for (const MethodResult* made : order) {
    const MethodScore& s = made->score;
    const auto own = merit(s, rule);
    std::vector<ReportTable::Cell> row = {made->method.name};
    if (rule == EqualBy::kError) row.emplace_back(s.seconds_to_error ? with_error(*s.seconds_to_error) : "not reached");
    row.emplace_back(with_error(s.rmse) + (s.is_lost_in_reference ? " (below the reference's)" : ""));
    row.emplace_back(with_error(s.relative));
    row.emplace_back(with_error(s.psnr));
    row.emplace_back(with_error(s.rel_mse));
    row.emplace_back(with_error(s.cost));
    row.emplace_back(own && best ? with_error(ratio_of(*own, *best)) : "");
    row.emplace_back(with_error(s.mean_ratio));
    row.emplace_back(s.samples.value);
    row.emplace_back(s.seconds.value);
    row.emplace_back(s.wall);
    row.emplace_back(s.slope ? fmt::format("{:.2f}", *s.slope) : "");
    table.rows.push_back(std::move(row));
  }
  return table;
}

ReportTable published_of(const ExperimentResult& result) {
  ReportTable table{.title = "What was published, and ours",
                    .columns = {"from", "number", "published", "ours", "ours / published"},
                    .rows = {}};
  for (const NumberBesideOurs& n : beside_ours(result)) {
    const bool decibels = n.published.measure == "psnr";
    std::string compared = "";
    if (n.compared())
      compared = decibels ? fmt::format("{:+.1f} dB", *n.compared()) : fmt::format("{:.2f}", *n.compared());
    table.rows.push_back(
        {n.published.from, n.what, n.published.value, n.ours ? with_error(*n.ours) : "not reached", compared});
  }
  return table;
}

ReportTable references_of(const ExperimentResult& result) {
  ReportTable table{.title = "References: their own error is subtracted from squared errors",
                    .columns = {"scene", "integrator", "samples", "wall time, s", "own RMSE", "own RMSE / mean",
                                "own RMSE by the variance of samples", "rendered by"},
                    .rows = {}};
  for (const SceneResult& scene : result.scenes) {
    const Reference& r = scene.reference;
    const double own = std::sqrt(r.error.mse.value);
    table.rows.push_back({scene.scene.name, scene.scene.reference.integrator, static_cast<double>(r.samples), r.wall,
                          with_error({own, r.error.mse.error / (2 * own)}), own / r.error.mean,
                          std::sqrt(r.error.by_variance), r.version});
  }
  return table;
}

ReportTable shortcomings_of(const ExperimentResult& result) {
  ReportTable table{.title = "What methods cannot find", .columns = {"scene", "method", ""}, .rows = {}};
  for (const SceneResult& scene : result.scenes)
    for (const MethodResult& made : scene.methods)
      for (const std::string& text : made.shortcomings)
        table.rows.push_back({scene.scene.name, made.method.name, text});
  return table;
}

ReportTable commands_of(const ExperimentResult& result) {
  ReportTable table{.title = "Commands that make such images", .columns = {"scene", "method", "command"}, .rows = {}};
  for (const SceneResult& scene : result.scenes)
    for (const MethodResult& made : scene.methods)
      table.rows.push_back(
          {scene.scene.name, made.method.name,
           fmt::format("{} --spp {:.0f} --seed 1", made.command, std::round(made.score.samples.value))});
  return table;
}

/// relMSE, which a few bright pixels do not rule, may see another method ahead: its name, when that is sure.
std::string ahead_by_relative_error(const std::vector<const MethodResult*>& order, EqualBy rule) {
  const auto value_of = [&](const MethodResult* made) {
    const double times = rule == EqualBy::kTime ? made->score.seconds.value : 1;
    return Estimate{times * made->score.rel_mse.value, times * made->score.rel_mse.error};
  };
  const auto* least = *std::ranges::min_element(order, {}, [&](const auto* made) { return value_of(made).value; });
  const Estimate ahead = value_of(least), first = value_of(order.front());
  return first.value - ahead.value > 2 * std::hypot(first.error, ahead.error) ? least->method.name : "";
}

/// What to know before believing a rank: pictures too dark or too bright, and those of hardly any samples.
std::string cautions(const std::vector<const MethodResult*>& order) {
  constexpr double kFewSamples = 4, kMuch = 0.05, kSure = 3;
  std::string off, few;
  const auto add = [](std::string& list, const std::string& name, double value, int digits) {
    list += fmt::format("{}{} ({:.{}f})", list.empty() ? "" : ", ", name, value, digits);
  };
  for (const MethodResult* made : order) {
    const Estimate& mean = made->score.mean_ratio;
    if (std::abs(mean.value - 1) > std::max(kMuch, kSure * mean.error)) add(off, made->method.name, mean.value, 2);
    if (made->score.samples.value < kFewSamples) add(few, made->method.name, made->score.samples.value, 0);
  }
  std::string text;
  if (!off.empty()) text += " Not as bright as the reference, which is 1: " + off + ".";
  if (!few.empty()) text += " Fewer samples per pixel than 4: " + few + ".";
  return text;
}

}  // namespace

std::string with_error(const Estimate& e) {
  if (!std::isfinite(e.value)) return "–";
  if (!std::isfinite(e.error) || !(e.error > 0)) return fmt::format("{:.4g}", e.value);
  // Two digits of the uncertainty decide how many of the value are worth showing.
  const int digits = static_cast<int>(std::floor(std::log10(e.error))) - 1;
  const double size = std::max(std::abs(e.value), e.error);
  if (size < 1e-3 || size >= 1e5)
    return fmt::format("{:.{}e} ± {:.1e}", e.value,
                       std::clamp(static_cast<int>(std::floor(std::log10(size))) - digits, 0, 6), e.error);
  const int places = std::clamp(-digits, 0, 8);
  return fmt::format("{:.{}f} ± {:.{}f}", e.value, places, e.error, places);
}

ReportVerdict verdict_of(const SceneResult& scene, EqualBy rule) {
  const auto order = ranked(scene, rule);
  ReportVerdict verdict{.place = scene.scene.name, .winner = order.front()->method.name, .text = {}};
  const auto best = merit(order.front()->score, rule);
  if (!best) {
    verdict.winner.clear();
    verdict.text = "no method came to the error asked for in the time given.";
    return verdict;
  }
  if (order.front()->score.is_lost_in_reference && best->value < 2 * best->error) {
    verdict.winner = "undecided";
    verdict.text =
        "the reference's own squared error is more than half of what is seen; more time would tell (--time-scale).";
    if (const std::string other = ahead_by_relative_error(order, rule); !other.empty())
      verdict.text += " By relMSE, which a few bright pixels do not rule, " + other + " is ahead.";
    return verdict;
  }
  std::string ties, behind, never;
  const auto add = [](std::string& list, const std::string& item) { list += (list.empty() ? "" : "; ") + item; };
  for (size_t i = 1; i < order.size(); ++i) {
    const std::string& name = order[i]->method.name;
    const auto own = merit(order[i]->score, rule);
    if (!own) {
      add(never, name);
      continue;
    }
    add(is_surely_worse(scene, *order[i], *order.front(), rule) ? behind : ties,
        times(own->value / best->value) + " " + name);
  }
  verdict.text = fmt::format("{}.", unit_of(rule));
  if (!ties.empty()) verdict.text += " Not surely worse: " + ties + ".";
  if (!behind.empty())
    verdict.text += (rule == EqualBy::kSamples ? " Error of the others over it: "
                                               : " Time that the others need for the same error: ") +
                    behind + ".";
  if (const std::string other = ahead_by_relative_error(order, rule); !other.empty())
    verdict.text += " By relMSE, which a few bright pixels do not rule, " + other + " is ahead.";
  if (!never.empty()) verdict.text += " Not there in the time given: " + never + ".";
  verdict.text += cautions(order);
  return verdict;
}

Report report_of(const ExperimentResult& result, const std::map<std::string, std::string>& about) {
  const Experiment& experiment = result.experiment;
  Report report{.title = experiment.title};
  report.subtitle = fmt::format(
      "{}{}{}Compared at {}; {} seeds.{}", experiment.figure, experiment.figure.empty() ? "" : ". ",
      experiment.about.empty() ? "" : experiment.about + " ", describe(result.rule), experiment.seeds,
      result.time_scale < 1 ? fmt::format(" A short run: all times are {:g} of the experiment's.", result.time_scale)
                            : "");
  for (const SceneResult& scene : result.scenes) {
    report.verdicts.push_back(verdict_of(scene, result.rule.equal));
    report.groups.push_back(group_of(scene, result.rule.equal));
    report.plots.push_back(plot_of(scene));
    report.tables.push_back(numbers_of(scene, result.rule.equal));
  }
  report.glossary = glossary_of(experiment);
  if (!experiment.baseline.empty()) report.overview.push_back(baseline_table(result));
  if (!experiment.pairs.empty()) report.overview.push_back(pairs_table(result));
  if (!experiment.published.empty()) report.tables.push_back(published_of(result));
  report.tables.push_back(references_of(result));
  if (ReportTable table = shortcomings_of(result); !table.rows.empty()) report.tables.push_back(std::move(table));
  report.tables.push_back(commands_of(result));
  for (const auto& [name, value] : about) report.facts.emplace_back(name, value);
  report.facts.emplace_back("times",
                            "processor time of all threads, with preparation, without reading the scene; uncertainties "
                            "are standard errors over the seeds");
  return report;
}

}  // namespace turbid
