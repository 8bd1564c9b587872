#include "scene/properties.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "scene/suggestions.h"
#include "scene/values.h"

namespace turbid {
namespace {

std::string describe_expected(ParameterType type) {
  const std::string name = to_string(type);
  if (type == ParameterType::kFile) return "a string that names a file";
  return (name[0] == 'i' ? "an " : "a ") + name;
}

/// Does a value that has a type fit the parameter?
bool fits(ParameterType type, const Value& value) {
  const bool number = std::holds_alternative<double>(value) || std::holds_alternative<int64_t>(value);
  const bool text = std::holds_alternative<std::string>(value);
  switch (type) {
    case ParameterType::kBoolean:
      return std::holds_alternative<bool>(value);
    case ParameterType::kInteger:
      return std::holds_alternative<int64_t>(value);
    case ParameterType::kFloat:
      return number;
    case ParameterType::kString:
    case ParameterType::kFile:
      return text;
    case ParameterType::kPoint:
    case ParameterType::kVector:
      return std::holds_alternative<Imath::V3d>(value);
    case ParameterType::kSpectrum:
    case ParameterType::kTexture:
      return number || std::holds_alternative<Spectrum>(value);
    case ParameterType::kFloatOrVector:
      return number || std::holds_alternative<Spectrum>(value) || std::holds_alternative<Imath::V3d>(value);
    case ParameterType::kIor:
    case ParameterType::kFloatOrString:
      return number || text;
    case ParameterType::kTransform:
      return std::holds_alternative<Transform>(value);
    default:
      return false;
  }
}

/// Reads text from the command line or a table as the parameter's type.
Value read_as(ParameterType type, const std::string& text, const SourceLocation& where) {
  switch (type) {
    case ParameterType::kBoolean:
      return read_boolean(text, where);
    case ParameterType::kInteger:
      return read_integer(text, where);
    case ParameterType::kFloat:
      return read_number(text, where);
    case ParameterType::kPoint:
    case ParameterType::kVector:
      return read_vector(text, where);
    case ParameterType::kSpectrum:
    case ParameterType::kTexture:
    case ParameterType::kFloatOrVector:
      return read_rgb(text, where);
    case ParameterType::kTransform:
      if (text == "identity") return Transform();
      break;
    case ParameterType::kIor:
    case ParameterType::kFloatOrString:
      if (text.find_first_not_of("0123456789.+-e ") == std::string::npos) return read_number(text, where);
      break;
    default:
      break;
  }
  return text;
}

double to_double(const Value& value) {
  if (const auto* integer = std::get_if<int64_t>(&value)) return static_cast<double>(*integer);
  return std::get<double>(value);
}

Spectrum to_spectrum(const Value& value) {
  if (const auto* spectrum = std::get_if<Spectrum>(&value)) return *spectrum;
  if (const auto* v = std::get_if<Imath::V3d>(&value))
    return {static_cast<float>(v->x), static_cast<float>(v->y), static_cast<float>(v->z)};
  return Spectrum(static_cast<float>(to_double(value)));
}

bool is_number(const Value& value) {
  return std::holds_alternative<int64_t>(value) || std::holds_alternative<double>(value);
}

ParameterType type_of_children(Category category) {
  switch (category) {
    case Category::kBsdf:
      return ParameterType::kBsdf;
    case Category::kEmitter:
      return ParameterType::kEmitter;
    case Category::kMedium:
      return ParameterType::kMedium;
    case Category::kPhase:
      return ParameterType::kPhase;
    case Category::kFilm:
      return ParameterType::kFilm;
    case Category::kSampler:
      return ParameterType::kSampler;
    case Category::kFilter:
      return ParameterType::kFilter;
    case Category::kIntegrator:
      return ParameterType::kIntegrator;
    case Category::kShape:
      return ParameterType::kShape;
    default:
      return ParameterType::kTexture;
  }
}

}  // namespace

Properties::Properties(const SceneNode& node, const std::vector<Parameter>& list, const SceneDocument* document)
    : node_(&node), list_(&list), document_(document) {
  match_values();
  match_children();
  report_unknown();
  for (const Parameter& known : list) check(known);
}

void Properties::match_values() {
  for (const NamedValue& value : node_->values) {
    const auto known =
        std::find_if(list_->begin(), list_->end(), [&](const Parameter& p) { return p.name == value.name; });
    if (known == list_->end())
      unknown_.push_back({"", value.name, value.name_where.file.empty() ? value.where : value.name_where});
    else
      given_[value.name].value = &value;
  }
}

/// A child takes the parameter of its name. Where the plugin has one parameter of its kind, or several that are not
/// told apart by names (the two phase functions of a blend), other names and none do as well, in the order of the file.
const Parameter* Properties::parameter_for(const Child& child) const {
  const ParameterType type = type_of_children(child.node->category);
  const bool value = child.node->category == Category::kTexture || child.node->category == Category::kVolume;
  size_t same_type = 0;
  const Parameter *free = nullptr, *nameless = nullptr;
  for (const Parameter& known : *list_) {
    const bool matches = value ? !is_plugin(known.type) : known.type == type;
    if (matches && known.name == child.name && !given_.contains(known.name)) return &known;
    if (value && known.any_name && !given_.contains(known.name)) nameless = &known;
    if (known.type != type) continue;
    ++same_type;
    if (!free && !given_.contains(known.name)) free = &known;
  }
  if (nameless) return nameless;
  const bool by_name = value || (type == ParameterType::kMedium && same_type > 1);
  const bool plugin_category = type != ParameterType::kTexture;
  return by_name || !plugin_category ? nullptr : free;
}

void Properties::match_children() {
  for (const Child& child : node_->children) {
    if (const Parameter* known = parameter_for(child)) {
      given_[known->name].child = &child;
      continue;
    }
    const std::string tag = to_string(child.node->category);
    if (!child.name.empty()) {
      unknown_.push_back({"the " + tag + " ", child.name, child.where});
      continue;
    }
    const bool vowel = std::string("aeiou").find(tag[0]) != std::string::npos;
    std::string names;  // that it could have had
    for (const Parameter& known : *list_)
      if (child.node->category != Category::kShape && known.type == type_of_children(child.node->category))
        names += (names.empty() ? "" : ", ") + known.name;
    unknown_.push_back(
        {(vowel ? "an " : "a ") + tag + " without a name" + (names.empty() ? "" : " (expected one of: " + names + ")"),
         "", child.where});
  }
}

void Properties::report_unknown() const {
  if (unknown_.empty()) return;
  std::vector<std::string> names;
  for (const Parameter& known : *list_) names.push_back(known.name);
  std::string message =
      std::string("unknown parameter") + (unknown_.size() > 1 ? "s" : "") + " of " + node_->describe() + ": ";
  for (size_t i = 0; i < unknown_.size(); ++i) {
    const Unknown& unknown = unknown_[i];
    if (i > 0) message += "; ";
    message += unknown.what;
    if (!unknown.name.empty()) message += "'" + unknown.name + "'";
    if (i > 0) message += " in line " + std::to_string(unknown.where.line);
    message += unknown.name.empty() ? "" : suggestion(unknown.name, names);
  }
  if (list_->empty()) message += " (it has none)";
  throw SceneError(unknown_.front().where, message);
}

void Properties::check(const Parameter& known) const {
  const auto given = given_.find(known.name);
  if (given == given_.end()) {
    if (known.default_text == kRequired)
      throw SceneError(node_->where, node_->describe() + " needs the parameter '" + known.name + "' (" +
                                         describe_expected(known.type) + ": " + known.meaning + ")");
    return;
  }
  if (given->second.child) {
    const bool value = !is_plugin(known.type);
    if (value && known.type != ParameterType::kTexture && known.type != ParameterType::kSpectrum)
      refuse(known.name, "expects " + describe_expected(known.type) + ", found a " +
                             to_string(given->second.child->node->category));
    return;
  }
  const Value typed = value(known);
  if (!fits(known.type, typed))
    refuse(known.name, "expects " + describe_expected(known.type) + ", found " + describe_type(typed));
  if (is_number(typed) && !known.range.contains(to_double(typed)))
    refuse(known.name, fmt::format("is {}, expected a number {}", to_double(typed), known.range.describe()));
  if (std::holds_alternative<Spectrum>(typed)) check_range(known.name, std::get<Spectrum>(typed));
  if (const auto* text = std::get_if<std::string>(&typed); text && !known.choices.empty())
    if (std::find(known.choices.begin(), known.choices.end(), *text) == known.choices.end())
      refuse(known.name, "cannot be '" + *text + "'" + suggestion(*text, known.choices));
}

void Properties::check_range(const std::string& name, const Spectrum& spectrum) const {
  const Range& range = parameter(name).range;
  for (int c = 0; c < kChannels; ++c)
    if (!range.contains(static_cast<double>(spectrum[c])))
      refuse(name, fmt::format("is ({:.6g}, {:.6g}, {:.6g}), expected numbers {}", spectrum[0], spectrum[1],
                               spectrum[2], range.describe()));
}

const Parameter& Properties::parameter(const std::string& name) const {
  for (const Parameter& known : *list_)
    if (known.name == name) return known;
  throw std::logic_error(node_->describe() + " asks for '" + name + "', which is not in its parameter list");
}

Value Properties::value(const Parameter& known) const {
  const auto given = given_.find(known.name);
  if (given == given_.end() || !given->second.value) {
    if (known.default_text == kOptional && known.type != ParameterType::kString)
      throw std::logic_error(node_->describe() + ": '" + known.name + "' has no default");
    return read_as(known.type, known.default_text, node_->where);
  }
  const NamedValue& named = *given->second.value;
  if (const auto* untyped = std::get_if<UntypedText>(&named.value)) {
    try {
      return read_as(known.type, untyped->text, named.where);
    } catch (const SceneError& error) {
      throw SceneError(named.where, "'" + known.name + "' of " + node_->describe() + ": " + error.reason());
    }
  }
  return named.value;
}

bool Properties::has(const std::string& name) const { return given_.contains(parameter(name).name); }

bool Properties::has_value(const std::string& name) const {
  const std::string& text = parameter(name).default_text;
  return has(name) || (text != kOptional && text != kRequired);
}

SourceLocation Properties::where(const std::string& name) const {
  const auto given = given_.find(name);
  if (given == given_.end()) return node_->where;
  return given->second.value ? given->second.value->where : given->second.child->where;
}

bool Properties::boolean(const std::string& name) const { return std::get<bool>(value(parameter(name))); }
int64_t Properties::integer(const std::string& name) const { return std::get<int64_t>(value(parameter(name))); }
float Properties::number(const std::string& name) const {
  return static_cast<float>(to_double(value(parameter(name))));
}
std::string Properties::string(const std::string& name) const { return std::get<std::string>(value(parameter(name))); }
Spectrum Properties::spectrum(const std::string& name) const { return to_spectrum(value(parameter(name))); }
Transform Properties::transform(const std::string& name) const { return std::get<Transform>(value(parameter(name))); }
Vec3 Properties::vector(const std::string& name) const { return Vec3(std::get<Imath::V3d>(value(parameter(name)))); }

bool Properties::is_string(const std::string& name) const {
  return std::holds_alternative<std::string>(value(parameter(name)));
}

std::filesystem::path Properties::file(const std::string& name) const {
  const std::string text = string(name);
  const std::filesystem::path path = document_ ? document_->resolve(text) : std::filesystem::path(text);
  if (file_exists(path)) return path;
  std::string folders;
  if (document_)
    for (const auto& folder : document_->search_folders)
      folders += (folders.empty() ? "" : ", ") + (folder.empty() ? "." : folder.string());
  throw SceneError(where(name),
                   "there is no file '" + text + "'" + (folders.empty() ? "" : " (looked in: " + folders + ")"));
}

const SceneNode* Properties::child(const std::string& name) const {
  const auto given = given_.find(parameter(name).name);
  return given == given_.end() || !given->second.child ? nullptr : given->second.child->node.get();
}

void Properties::refuse(const std::string& name, const std::string& message) const {
  throw SceneError(where(name), "'" + name + "' of " + node_->describe() + " " + message);
}

}  // namespace turbid
