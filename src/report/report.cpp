#include "report/report.h"

#include <Imath/half.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "core/error.h"
#include "image/atomic_file.h"
#include "report/base64.h"

namespace turbid {
namespace {

using Json = nlohmann::ordered_json;

/// JSON has no infinity: what is not finite is left out.
void put(Json& json, const char* name, std::optional<double> value) {
  if (value && std::isfinite(*value)) json[name] = *value;
}

float largest_finite(const ChannelList& channels) {
  float largest = 0;
  for (const auto& channel : channels)
    for (const float value : channel)
      if (std::isfinite(value)) largest = std::max(largest, std::abs(value));
  return largest;
}

Json pixels_of(const ReportImage& shown) {
  const ChannelList channels = color_channels(shown.image, shown.name);
  // At most half of the largest half.
  const int exponent = largest_finite(channels) > 0 ? std::ilogb(largest_finite(channels)) - 14 : 0;
  const int scale = std::max(0, exponent);
  std::vector<unsigned char> bytes;
  bytes.reserve(channels[0].size() * 6);
  for (size_t i = 0; i < channels[0].size(); ++i)
    for (size_t c = 0; c < 3; ++c) {
      const uint16_t bits = half(std::ldexp(channels[c][i], -scale)).bits();
      bytes.push_back(static_cast<unsigned char>(bits & 255));
      bytes.push_back(static_cast<unsigned char>(bits >> 8));
    }
  return {{"width", shown.image.width()},
          {"height", shown.image.height()},
          {"scale", std::ldexp(1.0, scale)},
          {"pixels", to_base64(bytes)}};
}

Json image_json(const ReportImage& shown) {
  Json json = {{"name", shown.name}, {"reference", shown.is_reference}};
  json.update(pixels_of(shown));
  Json metrics = Json::object();
  put(metrics, "seconds", shown.seconds);
  put(metrics, "samples", shown.samples);
  if (shown.metrics) {
    put(metrics, "rmse", shown.metrics->rmse);
    put(metrics, "psnr", shown.metrics->psnr);
    put(metrics, "rel_mse", shown.metrics->rel_mse);
    put(metrics, "mean_ratio", shown.metrics->mean_ratio);
    if (shown.cost || shown.seconds)
      put(metrics, "cost", shown.cost ? *shown.cost : std::pow(shown.metrics->rmse, 2) * *shown.seconds);
    if (shown.errors) {
      put(metrics, "rmse_error", shown.errors->rmse);
      put(metrics, "psnr_error", shown.errors->psnr);
      put(metrics, "rel_mse_error", shown.errors->rel_mse);
      put(metrics, "mean_ratio_error", shown.errors->mean_ratio);
      put(metrics, "cost_error", shown.errors->cost);
    }
    json["metrics"] = metrics;
  } else if (!metrics.empty()) {
    json["facts"] = metrics;
  }
  return json;
}

Json plot_json(const ReportPlot& plot) {
  Json series = Json::array();
  for (const ReportPlot::Series& s : plot.series) {
    Json json = {{"name", s.name}, {"x", s.x}, {"y", s.y}};
    if (!s.low.empty()) json.update({{"low", s.low}, {"high", s.high}});
    series.push_back(json);
  }
  return {{"title", plot.title},
          {"x_label", plot.x_label},
          {"y_label", plot.y_label},
          {"log", plot.logarithmic},
          {"series", series}};
}

Json table_json(const ReportTable& table) {
  Json rows = Json::array();
  for (const auto& row : table.rows) {
    Json cells = Json::array();
    for (const ReportTable::Cell& cell : row) std::visit([&](const auto& value) { cells.push_back(value); }, cell);
    rows.push_back(cells);
  }
  return {{"title", table.title}, {"columns", table.columns}, {"rows", rows}};
}

}  // namespace

Json to_json(const Report& report) {
  Json verdicts = Json::array(), overview = Json::array(), glossary = Json::array(), groups = Json::array(),
       plots = Json::array(), tables = Json::array(), facts = Json::object();
  for (const ReportVerdict& v : report.verdicts)
    verdicts.push_back({{"place", v.place}, {"winner", v.winner}, {"text", v.text}});
  for (const ReportGroup& group : report.groups) {
    Json images = Json::array();
    for (const ReportImage& image : group.images) images.push_back(image_json(image));
    groups.push_back({{"title", group.title}, {"exposure", group.exposure}, {"images", images}});
  }
  for (const ReportTable& table : report.overview) overview.push_back(table_json(table));
  for (const ReportTerm& term : report.glossary) glossary.push_back({{"name", term.name}, {"text", term.text}});
  for (const ReportPlot& plot : report.plots) plots.push_back(plot_json(plot));
  for (const ReportTable& table : report.tables) tables.push_back(table_json(table));
  for (const auto& [name, value] : report.facts) facts[name] = value;
  return {{"title", report.title}, {"subtitle", report.subtitle},
          {"verdicts", verdicts},  {"overview", overview},
          {"glossary", glossary},  {"groups", groups},
          {"plots", plots},        {"tables", tables},
          {"facts", facts}};
}

std::string to_html(const Report& report, const std::string& viewer) {
  static const std::string kPlace = "<!--report-->";
  const size_t at = viewer.find(kPlace);
  if (at == std::string::npos) throw std::invalid_argument("the viewer has no place for a report");
  std::string json = to_json(report).dump(-1, ' ', false, Json::error_handler_t::replace);
  // Inside a script element, nothing may look like its end or like a comment.
  for (size_t i = 0; (i = json.find('<', i)) != std::string::npos; i += 6) json.replace(i, 1, "\\u003c");
  return viewer.substr(0, at) + json + viewer.substr(at + kPlace.size());
}

std::string read_viewer() {
  std::vector<std::string> places = {TURBID_VIEWER_BUILT, TURBID_VIEWER_INSTALLED};
  if (const char* named = std::getenv("TURBID_VIEWER")) places = {named};
  for (const std::string& place : places)
    if (std::filesystem::exists(place)) return read_file(place);
  throw UsageError("the viewer is not built: run ./turbid viewer, or name its page by TURBID_VIEWER");
}

}  // namespace turbid
