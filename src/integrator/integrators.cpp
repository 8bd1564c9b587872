#include "integrator/integrators.h"

#include "integrator/aov.h"
#include "integrator/bdpt.h"
#include "integrator/many_lights.h"
#include "integrator/mcrt.h"
#include "integrator/particle_tracer.h"
#include "integrator/path_tracer.h"

namespace turbid {
namespace {

/// Integrators of Mitsuba 0.6 that make the picture of volpath in another way. Whoever adds one takes it off the list.
std::map<std::string, std::string> advice_for_old_names() {
  std::map<std::string, std::string> advice;
  for (const char* name : {"photonmapper", "ppm", "sppm", "mlt", "pssmlt", "erpt", "adaptive", "irrcache"})
    advice[name] = "'volpath' makes the same picture by path tracing (--integrator volpath)";
  return advice;
}

IntegratorPlugin moment_row() {
  return {"moment",
          {},
          "wraps an image integrator and writes the mean square of its samples too (layers m2_*)",
          {{"integrator", ParameterType::kIntegrator, kRequired, "the image integrator"},
           {"scene_unit", ParameterType::kString, kOptional, "as in the image integrators"}},
          [](const Properties& properties) {
            IntegratorSetup setup = integrator_table().make(*properties.child("integrator"), nullptr);
            setup.second_moment = true;
            return setup;
          }};
}

IntegratorTable make_table() {
  return IntegratorTable(
      Category::kIntegrator,
      {path_row(), direct_row(), volpath_row(), single_scatter_row(), particle_tracer_row(), bdpt_row(), mcrt_row(),
       vpl_row(), vrl_row(), moment_row(), aov_row()},
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

const IntegratorTable& integrator_table() {
  static const IntegratorTable table = make_table();
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
