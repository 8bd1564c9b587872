// The integrator of a scene file, which the integrator room will make.
#include "scene/scene_loader.h"
#include "scene/values.h"

namespace turbid {
namespace {

/// The value called scene_unit, of the node or of an integrator inside it.
const NamedValue* find_unit(const SceneNode& node) {
  for (const NamedValue& value : node.values)
    if (value.name == "scene_unit") return &value;
  for (const Child& child : node.children)
    if (child.node->category == Category::kIntegrator)
      if (const NamedValue* value = find_unit(*child.node)) return value;
  return nullptr;
}

double metres(const std::string& text, const SourceLocation& where) {
  static const std::map<std::string, double> kUnits = {{"um", 1e-6}, {"mm", 1e-3}, {"cm", 1e-2},
                                                       {"dm", 1e-1}, {"m", 1},     {"km", 1e3}};
  if (const auto unit = kUnits.find(text); unit != kUnits.end()) return unit->second;
  if (text.find_first_of("0123456789") != std::string::npos) return read_number(text, where);
  throw SceneError(where, "'" + text + "' is not a length, expected um, mm, cm, dm, m, km or a number of metres");
}

}  // namespace

IntegratorDescription find_integrator(const SceneDocument& document) {
  IntegratorDescription result;
  for (const Child& child : document.root->children) {
    if (child.node->category != Category::kIntegrator || child.node == result.node) continue;
    if (result.declared)
      throw SceneError(child.where, "a scene has one integrator, found " + child.node->describe() + " after " +
                                        result.node->describe() + " in line " +
                                        std::to_string(result.node->where.line));
    result = {child.node, true};
  }
  if (result.declared) return result;
  auto node = std::make_shared<SceneNode>();
  node->category = Category::kIntegrator;
  node->type = "path";
  node->where = document.root->where;
  return {node, false};
}

double find_scene_unit(const SceneNode& integrator) {
  const NamedValue* unit = find_unit(integrator);
  if (!unit) return 0;
  double size = 0;
  if (const auto* number = std::get_if<double>(&unit->value))
    size = *number;
  else if (const auto* integer = std::get_if<int64_t>(&unit->value))
    size = static_cast<double>(*integer);
  else if (const auto* text = std::get_if<std::string>(&unit->value))
    size = metres(*text, unit->where);
  else if (const auto* untyped = std::get_if<UntypedText>(&unit->value))
    size = metres(untyped->text, unit->where);
  else
    throw SceneError(unit->where, "'scene_unit' expects a string or a float, found " + describe_type(unit->value));
  if (!(size > 0)) throw SceneError(unit->where, "'scene_unit' must be above 0");
  return size;
}

void set_value(SceneNode& node, const std::string& name, const std::string& text, const SourceLocation& where) {
  std::erase_if(node.values, [&](const NamedValue& value) { return value.name == name; });
  node.values.push_back({name, UntypedText{text}, where});
}

}  // namespace turbid
