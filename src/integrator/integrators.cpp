#include "integrator/integrators.h"

#include "integrator/aov.h"
#include "integrator/bdpt.h"
#include "integrator/particle_tracer.h"
#include "integrator/path_tracer.h"

namespace turbid {
namespace {

using Table = PluginTable<IntegratorSetup>;

const std::string kNoLimit = "-1";

/// What all image integrators understand, followed by their own parameters.
std::vector<Parameter> with_common(std::vector<Parameter> own, const std::string& max_depth = kNoLimit) {
  const Range count_or_unlimited{.min = -1};
  std::vector<Parameter> all = {
      {"max_depth", ParameterType::kInteger, max_depth,
       "most edges of a path from light to sensor; 1: lights only, 2: one scattering; -1: no limit",
       count_or_unlimited},
      {"rr_depth", ParameterType::kInteger, "5", "edges before Russian roulette begins", kNonNegative},
      {"min_scattering", ParameterType::kInteger, "0", "least collisions in media of a path that counts", kNonNegative},
      {"max_scattering", ParameterType::kInteger, kNoLimit,
       "most collisions in media of a path that counts; -1: no limit", count_or_unlimited},
      {"hide_emitters", ParameterType::kBoolean, "false", "lights are not seen directly"},
      {"scene_unit", ParameterType::kString, "m",
       "length of one scene unit, for media given per mm, cm or m: mm, cm, m, or a number of metres"},
      {"block_size", ParameterType::kInteger, "0", "accepted for Mitsuba's sake, without effect", kNonNegative},
      {"samples_per_pass", ParameterType::kInteger, "-1", "accepted for Mitsuba's sake, without effect"},
  };
  all.insert(all.end(), std::make_move_iterator(own.begin()), std::make_move_iterator(own.end()));
  return all;
}

int unlimited_if_negative(int64_t value) {
  return value < 0 ? PathSettings::kUnlimited : static_cast<int>(std::min<int64_t>(value, PathSettings::kUnlimited));
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

IntegratorSetup make_path_tracer(PathTracer::Kind kind, const Properties& properties) {
  return {std::make_shared<PathTracer>(kind, path_settings(properties)), false};
}

IntegratorSetup make_bdpt(const Properties& properties) {
  BdptSettings own;
  const std::string heuristic = properties.string("heuristic");
  if (heuristic != "power" && heuristic != "balance")
    properties.refuse("heuristic", "must be 'power' or 'balance', found '" + heuristic + "'");
  if (heuristic == "balance") own.heuristic = StrategyWeights::Heuristic::kBalance;
  own.connections = properties.number("connections");
  if (properties.boolean("visualize_strategies"))
    own.shown_edges = static_cast<int>(properties.integer("visualize_depth"));
  return {std::make_shared<BidirectionalPathTracer>(path_settings(properties), own), false};
}

/// Integrators of Mitsuba 0.6 that make the picture of volpath in another way. Whoever adds one takes it off the list.
std::map<std::string, std::string> advice_for_old_names() {
  std::map<std::string, std::string> advice;
  for (const char* name : {"photonmapper", "ppm", "sppm", "mlt", "pssmlt", "erpt", "vpl", "adaptive", "irrcache"})
    advice[name] = "'volpath' makes the same picture by path tracing (--integrator volpath)";
  return advice;
}

Table make_table() {
  return Table(
      Category::kIntegrator,
      {
          {"path",
           {},
           "path tracing on surfaces; media are ignored",
           with_common({}),
           [](const Properties& p) { return make_path_tracer(PathTracer::Kind::kSurfaces, p); }},
          {"direct",
           {},
           "light that reaches the sensor after at most one scattering: path with max_depth = 2",
           with_common(
               {{"shading_samples", ParameterType::kInteger, "1", "accepted for Mitsuba's sake, without effect"},
                {"emitter_samples", ParameterType::kInteger, "1", "accepted for Mitsuba's sake, without effect"},
                {"bsdf_samples", ParameterType::kInteger, "1", "accepted for Mitsuba's sake, without effect"}},
               "2"),
           [](const Properties& p) { return make_path_tracer(PathTracer::Kind::kSurfaces, p); }},
          {"volpath",
           {"volpathmis"},
           "path tracing with media: next-event estimation through null boundaries, all channels weighed together",
           with_common({}),
           [](const Properties& p) { return make_path_tracer(PathTracer::Kind::kVolumes, p); }},
          {"ptracer",
           {},
           "light tracing: paths from the lights, joined with the sensor; cannot see through mirrors and smooth glass",
           with_common({}),
           [](const Properties& p) {
             return IntegratorSetup{std::make_shared<ParticleTracer>(path_settings(p)), false};
           }},
          {"bdpt",
           {},
           "bidirectional path tracing: paths from lights and from the sensor, joined in all ways and weighed against "
           "each other",
           with_common({{"heuristic", ParameterType::kString, "power",
                         "how the ways to make a path share it: power or balance"},
                        {"connections",
                         ParameterType::kFloat,
                         "8",
                         "about how many of the joining lines are tried for paths of one length",
                         {.min = 1}},
                        {"visualize_strategies", ParameterType::kBoolean, "false",
                         "writes what each way contributes as layers strategy.weighted.K.S and strategy.plain.K.S: K "
                         "edges, S vertices from the light"},
                        {"visualize_depth",
                         ParameterType::kInteger,
                         "6",
                         "most edges of the paths in these layers",
                         {.min = 1, .max = 16}}}),
           make_bdpt},
          {"moment",
           {},
           "wraps an image integrator and writes the mean square of its samples too (layers m2_*)",
           {{"integrator", ParameterType::kIntegrator, kRequired, "the image integrator"},
            {"scene_unit", ParameterType::kString, kOptional, "as in the image integrators"}},
           [](const Properties& p) {
             const Properties& properties = p;
             IntegratorSetup setup = integrator_table().make(*properties.child("integrator"), nullptr);
             setup.second_moment = true;
             return setup;
           }},
          aov_row(),
      },
      {"stokes", "volprim_rf_basic", "prb", "prb_basic", "prbvolpath", "direct_projective", "prb_projective"},
      advice_for_old_names());
}

/// The chain of nodes from the outermost wrapper to the image integrator, as a copy that may be edited.
std::shared_ptr<SceneNode> copy_with_innermost(const SceneNode& node, std::shared_ptr<SceneNode> replacement) {
  for (size_t i = 0; i < node.children.size(); ++i) {
    if (node.children[i].node->category != Category::kIntegrator) continue;
    auto copy = std::make_shared<SceneNode>(node);
    copy->children[i].node = copy_with_innermost(*node.children[i].node, std::move(replacement));
    return copy;
  }
  return replacement;
}

const SceneNode& innermost(const SceneNode& node) {
  for (const Child& child : node.children)
    if (child.node->category == Category::kIntegrator) return innermost(*child.node);
  return node;
}

}  // namespace

const Table& integrator_table() {
  static const Table table = make_table();
  return table;
}

IntegratorSetup make_integrator(const IntegratorDescription& description, const SceneDocument* document) {
  return integrator_table().make(*description.node, document);
}

IntegratorReplacement replace_integrator(const IntegratorDescription& old, const std::string& type,
                                         const std::vector<std::pair<std::string, std::string>>& settings) {
  const SceneNode& previous = innermost(*old.node);
  auto node = std::make_shared<SceneNode>();
  node->category = Category::kIntegrator;
  node->type = type;
  const auto& row = integrator_table().row_of(*node);
  IntegratorReplacement result;
  for (const NamedValue& value : previous.values) {
    const bool known = std::any_of(row.parameters.begin(), row.parameters.end(),
                                   [&](const Parameter& parameter) { return parameter.name == value.name; });
    if (known) {
      node->values.push_back(value);
    } else {
      result.dropped.push_back(value.name);
    }
  }
  for (const auto& [name, text] : settings) set_value(*node, name, text);
  result.description = {copy_with_innermost(*old.node, std::move(node)), true};
  return result;
}

}  // namespace turbid
