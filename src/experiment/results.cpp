#include "experiment/results.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "experiment/relations.h"

namespace turbid {
namespace {

using Json = nlohmann::ordered_json;

/// JSON has no infinity: null.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
Json to_json(const Estimate& e) { return {{"value", number(e.value)}, {"error", number(e.error)}}; }
Json optional_json(const std::optional<Estimate>& e) { return e ? to_json(*e) : Json(nullptr); }

Json to_json(const MethodResult& made, size_t rank) {
  const MethodScore& s = made.score;
  Json curve = Json::array();
  for (const ScorePoint& p : s.curve)
    curve.push_back({{"seconds", number(p.seconds.value)},
                     {"samples", p.samples},
                     {"rmse", number(p.rmse.value)},
                     {"rmse_error", number(p.rmse.error)}});
  return {{"name", made.method.name},
          {"integrator", made.method.integrator},
          {"command", made.command},
          {"rank", rank},
          {"rmse", to_json(s.rmse)},
          {"relative_rmse", to_json(s.relative)},
          {"psnr", to_json(s.psnr)},
          {"rel_mse", to_json(s.rel_mse)},
          {"mean_ratio", to_json(s.mean_ratio)},
          {"cost", to_json(s.cost)},
          {"seconds", to_json(s.seconds)},
          {"wall_seconds", s.wall},
          {"samples", to_json(s.samples)},
          {"seconds_to_error", optional_json(s.seconds_to_error)},
          {"lost_in_reference", s.is_lost_in_reference},
          {"slope", s.slope ? number(*s.slope) : Json(nullptr)},
          {"shortcomings", made.shortcomings},
          {"curve", curve}};
}

Json to_json(const SceneResult& scene, EqualBy rule) {
  Json methods = Json::array();
  size_t rank = 0;
  for (const MethodResult* made : ranked(scene, rule)) methods.push_back(to_json(*made, ++rank));
  const Reference& r = scene.reference;
  return {{"name", scene.scene.name},
          {"file", scene.scene.file},
          {"definitions", scene.scene.definitions},
          {"width", r.image.width()},
          {"height", r.image.height()},
          {"reference",
           {{"integrator", scene.scene.reference.integrator},
            {"samples", r.samples},
            {"wall_seconds", r.wall},
            {"key", r.key},
            {"version", r.version},
            {"mean", r.error.mean},
            {"peak", r.error.peak},
            {"mse", to_json(r.error.mse)},
            {"mse_by_variance", r.error.by_variance}}},
          {"methods", methods}};
}

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + "\"";
}

}  // namespace

std::optional<double> NumberBesideOurs::compared() const {
  if (!ours) return {};
  return published.measure == "psnr" ? ours->value - published.value : ours->value / published.value;
}

std::vector<NumberBesideOurs> beside_ours(const ExperimentResult& result) {
  std::vector<NumberBesideOurs> all;
  for (const PublishedNumber& p : result.experiment.published) {
    NumberBesideOurs& made = all.emplace_back();
    made.published = p;
    made.what = fmt::format("{}: {} of {}", p.scene, p.measure, p.method);
    for (const SceneResult& scene : result.scenes) {
      if (scene.scene.name != p.scene) continue;
      made.ours = scene.method(p.method).score.get(p.measure);
      if (p.over.empty()) continue;
      const auto base = scene.method(p.over).score.get(p.measure);
      made.what += (p.measure == "psnr" ? " less that of " : " over that of ") + p.over;
      if (!base || !made.ours)
        made.ours.reset();
      else if (p.measure == "psnr")
        made.ours = Estimate{made.ours->value - base->value, std::hypot(made.ours->error, base->error)};
      else
        made.ours = ratio_of(*made.ours, *base);
    }
  }
  return all;
}

Json to_json(const ExperimentResult& result, const std::map<std::string, std::string>& about) {
  static const char* const kRules[] = {"equal time", "equal samples", "equal error"};
  const ComparisonRule& rule = result.rule;
  Json scenes = Json::array(), published = Json::array();
  for (const SceneResult& scene : result.scenes) scenes.push_back(to_json(scene, rule.equal));
  for (const NumberBesideOurs& n : beside_ours(result))
    published.push_back({{"from", n.published.from},
                         {"what", n.what},
                         {"published", n.published.value},
                         {"ours", optional_json(n.ours)},
                         {"compared", n.compared() ? number(*n.compared()) : Json(nullptr)}});
  return {{"format", 1},
          {"experiment", result.experiment.name},
          {"title", result.experiment.title},
          {"figure", result.experiment.figure},
          {"compare",
           {{"by", kRules[static_cast<int>(rule.equal)]},
            {"seconds", rule.seconds},
            {"samples", rule.samples},
            {"error", rule.error}}},
          {"seeds", result.experiment.seeds},
          {"time_scale", result.time_scale},
          {"about", about},
          {"scenes", scenes},
          {"published", published},
          {"against_baseline", baseline_json(result)},
          {"pairs", pairs_json(result)}};
}

std::string to_csv(const ExperimentResult& result) {
  std::string text = "scene,method,seed,seconds,wall_seconds,samples,rmse,rel_mse,mean_ratio\n";
  for (const SceneResult& scene : result.scenes)
    for (const MethodResult& made : scene.methods)
      for (size_t run = 0; run < made.runs.size(); ++run)
        for (const CurvePoint& p : made.runs[run])
          text += fmt::format("{},{},{},{:.4f},{:.4f},{},{:.8g},{:.8g},{:.8g}\n", quoted(scene.scene.name),
                              quoted(made.method.name), run + 1, p.seconds, p.wall, p.samples, std::sqrt(p.error.mse),
                              p.error.rel_mse, p.error.mean_ratio);
  return text;
}

}  // namespace turbid
