#include "integrator/integrator_plugin.h"

namespace turbid {
namespace {

int unlimited_if_negative(int64_t value) {
  return value < 0 ? PathSettings::kUnlimited : static_cast<int>(std::min<int64_t>(value, PathSettings::kUnlimited));
}

/// The words of a parameter and what they mean.
template <class Value>
using Words = std::vector<std::pair<std::string, Value>>;

const Words<ConnectionTechnique> kTechniques = {{"standard", ConnectionTechnique::kStandard},
                                                {"equiangular", ConnectionTechnique::kEquiangular},
                                                {"product", ConnectionTechnique::kProduct},
                                                {"once_more", ConnectionTechnique::kOnceMore},
                                                {"mis", ConnectionTechnique::kMis}};
const Words<Insertion> kInsertions = {
    {"angle", Insertion::kAngle}, {"seed", Insertion::kSolidAngle}, {"geometry", Insertion::kGeometry}};

template <class Value>
std::vector<std::string> choices(const Words<Value>& words) {
  std::vector<std::string> result;
  for (const auto& entry : words) result.push_back(entry.first);
  return result;
}

template <class Value>
Value meaning(const Words<Value>& words, const std::string& word) {
  return std::find_if(words.begin(), words.end(), [&](const auto& entry) { return entry.first == word; })->second;
}

}  // namespace

std::vector<Parameter> with_common_parameters(std::vector<Parameter> own, const std::string& max_depth) {
  const Range count_or_unlimited{.min = -1};
  std::vector<Parameter> all = {
      {"max_depth", ParameterType::kInteger, max_depth,
       "most edges of a path from light to sensor; 1: lights only, 2: one scattering; -1: no limit",
       count_or_unlimited},
      {"rr_depth", ParameterType::kInteger, "5", "edges before Russian roulette begins", kNonNegative},
      {"min_scattering", ParameterType::kInteger, "0", "least collisions in media of a path that counts", kNonNegative},
      {"max_scattering", ParameterType::kInteger, "-1", "most collisions in media of a path that counts; -1: no limit",
       count_or_unlimited},
      {"hide_emitters", ParameterType::kBoolean, "false", "lights are not seen directly"},
      {"scene_unit", ParameterType::kString, "m",
       "length of one scene unit, for media given per mm, cm or m: mm, cm, m, or a number of metres"},
      {"block_size", ParameterType::kInteger, "0", "accepted for Mitsuba's sake, without effect", kNonNegative},
      {"samples_per_pass", ParameterType::kInteger, "-1", "accepted for Mitsuba's sake, without effect"},
  };
  all.insert(all.end(), std::make_move_iterator(own.begin()), std::make_move_iterator(own.end()));
  return all;
}

PathSettings path_settings(const Properties& properties) {
  PathSettings settings;
  settings.max_depth = unlimited_if_negative(properties.integer("max_depth"));
  settings.rr_depth = static_cast<int>(properties.integer("rr_depth"));
  settings.min_scattering = static_cast<int>(properties.integer("min_scattering"));
  settings.max_scattering = unlimited_if_negative(properties.integer("max_scattering"));
  settings.hide_emitters = properties.boolean("hide_emitters");
  if (settings.min_scattering > settings.max_scattering)
    properties.refuse("min_scattering", "must not be above max_scattering");
  return settings;
}

Parameter word(const std::string& name, const std::string& value, const std::string& meaning,
               std::vector<std::string> choices) {
  return {name, ParameterType::kString, value, meaning, {}, std::move(choices)};
}

std::vector<Parameter> connection_parameters(const std::string& name, const std::string& end) {
  return {word(name, "standard",
               "how the collision next to the " + end +
                   " is found: standard (by the walk), equiangular or product (along the walk's ray), once_more "
                   "(inserted), mis (all but equiangular)",
               choices(kTechniques)),
          word("sampling", "angle",
               "of inserted collisions: angle (constant weight on the whole sphere), seed (as published, forward), "
               "geometry (joint importance sampling, for isotropic media)",
               choices(kInsertions))};
}

ConnectionSettings connection_settings(const Properties& properties, const std::string& name) {
  return {meaning(kTechniques, properties.string(name)), meaning(kInsertions, properties.string("sampling"))};
}

}  // namespace turbid
