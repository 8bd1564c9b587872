#include "experiment/glossary.h"

#include <fmt/format.h>

#include <algorithm>

#include "integrator/integrators.h"

namespace turbid {
namespace {

/// What a parameter's line says of one of its choices, in the brackets behind its name; else the whole line.
std::string meaning_of(const Parameter& parameter, const std::string& value) {
  const std::string& text = parameter.meaning;
  const bool is_choice = std::ranges::find(parameter.choices, value) != parameter.choices.end();
  for (size_t at = text.find(value + " ("); is_choice && at != std::string::npos;
       at = text.find(value + " (", at + 1)) {
    if (at > 0 && text[at - 1] != ' ') continue;  // the end of a longer name
    int open = 0;
    const size_t begin = at + value.size() + 2;
    for (size_t i = begin; i < text.size(); ++i) {
      if (text[i] == '(') ++open;
      if (text[i] == ')' && open-- == 0) return text.substr(begin, i - begin);
    }
  }
  return text;
}

using Settings = std::vector<std::pair<std::string, std::string>>;

/// The type, and "key=value" pairs.
std::pair<std::string, Settings> taken_apart(const std::string& integrator) {
  const size_t end = std::min(integrator.find(','), integrator.size());
  Settings settings;
  for (size_t at = end; at < integrator.size();) {
    const size_t next = std::min(integrator.find(',', at + 1), integrator.size());
    const std::string setting = integrator.substr(at + 1, next - at - 1);
    const size_t equals = std::min(setting.find('='), setting.size());
    settings.emplace_back(setting.substr(0, equals), setting.substr(std::min(equals + 1, setting.size())));
    at = next;
  }
  return {integrator.substr(0, end), settings};
}

/// Of the parameters that the integrator has.
std::string explain_settings(const std::string& type, const Settings& settings) {
  const auto* row = integrator_table().find(type);
  std::string text;
  for (const auto& [name, value] : settings)
    if (const auto parameter = std::ranges::find(row->parameters, name, &Parameter::name);
        parameter != row->parameters.end())
      text += fmt::format("{}{} = {}: {}", text.empty() ? "" : ". ", name, value, meaning_of(*parameter, value));
  return text;
}

}  // namespace

std::vector<ReportTerm> glossary_of(const Experiment& experiment) {
  std::vector<ReportTerm> terms;
  if (experiment.methods.empty()) return terms;
  // What all have is said once.
  auto [first, common] = taken_apart(experiment.methods.front().integrator);
  for (const ExperimentMethod& method : experiment.methods) {
    const Settings own = taken_apart(method.integrator).second;
    std::erase_if(common, [&](const auto& setting) { return std::ranges::find(own, setting) == own.end(); });
  }
  for (const ExperimentMethod& method : experiment.methods) {
    auto [type, settings] = taken_apart(method.integrator);
    const auto* row = integrator_table().find(type);
    if (!row) continue;
    std::erase_if(settings, [&](const auto& setting) { return std::ranges::find(common, setting) != common.end(); });
    const std::string more = explain_settings(type, settings);
    terms.push_back({method.name, fmt::format("{}: {}{}{}.", type, row->summary, more.empty() ? "" : ". ", more)});
  }
  if (!common.empty() && integrator_table().find(first))
    terms.push_back({"all of them", explain_settings(first, common) + "."});
  const std::vector<ReportTerm> measures = {
      {"reference", "a picture with much more time, by a method without bias; its own remaining error is subtracted."},
      {"RMSE", "root of the mean squared difference from the reference, over all pixels and channels."},
      {"RMSE² × time",
       "squared error times processor time: a method with half of it needs half the time for the same error."},
      {"relMSE", "squared difference over the squared reference: dark pixels count as much as bright ones."},
      {"PSNR", "in decibels, 20 log10 of the reference's 99th percentile over the RMSE: 6 more are half the error."},
      {"mean ratio", "brightness of the whole picture over the reference's; what is not 1 is bias, or not yet found."}};
  terms.insert(terms.end(), measures.begin(), measures.end());
  return terms;
}

}  // namespace turbid
