#include "render/scene_choice.h"

#include <fmt/format.h>

#include <charconv>
#include <filesystem>

#include "core/error.h"
#include "core/hash.h"
#include "core/log.h"
#include "core/version.h"
#include "image/atomic_file.h"
#include "integrator/integrators.h"
#include "render/default_scene.h"

namespace turbid {
namespace {

/// "name=value" cut at the first '='.
std::pair<std::string, std::string> read_assignment(const std::string& text, const std::string& option) {
  const size_t equals = text.find('=');
  if (equals == 0 || equals == std::string::npos)
    throw UsageError(fmt::format("{} expects name=value, found '{}'", option, text));
  return {text.substr(0, equals), text.substr(equals + 1)};
}

Overrides read_definitions(const std::vector<std::string>& definitions) {
  Overrides overrides;
  for (const std::string& definition : definitions) {
    const auto [name, value] = read_assignment(definition, "-D");
    if (!overrides.emplace(name, value).second) throw UsageError("-D gives '" + name + "' twice");
  }
  return overrides;
}

Vec2i read_size(const std::string& text) {
  constexpr int kMost = 1 << 20;
  Vec2i size;
  const char* end = text.data() + text.size();
  const auto width = std::from_chars(text.data(), end, size.x);
  if (width.ec == std::errc() && width.ptr != end && (*width.ptr == 'x' || *width.ptr == 'X')) {
    const auto height = std::from_chars(width.ptr + 1, end, size.y);
    if (height.ec == std::errc() && height.ptr == end && size.x > 0 && size.y > 0 && size.x <= kMost && size.y <= kMost)
      return size;
  }
  throw UsageError("--size expects WIDTHxHEIGHT in pixels, such as 640x480, found '" + text + "'");
}

/// A copy of the node with its first child of a category replaced (everywhere it is referred to), or with one more
/// child.
std::shared_ptr<SceneNode> with_child(const SceneNode& node, const std::shared_ptr<const SceneNode>& child) {
  auto copy = std::make_shared<SceneNode>(node);
  std::shared_ptr<const SceneNode> replaced;
  for (Child& old : copy->children) {
    if (old.node->category != child->category || (replaced && old.node != replaced)) continue;
    replaced = old.node;
    old.node = child;
  }
  if (!replaced) copy->children.push_back({"", child, child->where});
  return copy;
}

std::shared_ptr<const SceneNode> first_child(const SceneNode& node, Category category) {
  for (const Child& child : node.children)
    if (child.node->category == category) return child.node;
  return nullptr;
}

/// Gives the film of the first sensor another size; a crop window of the old one means nothing any more.
void set_film_size(SceneDocument& document, const Vec2i& size) {
  const auto sensor = first_child(*document.root, Category::kSensor);
  if (!sensor) throw UsageError("--size: the scene has no sensor");
  auto film = std::make_shared<SceneNode>();
  film->category = Category::kFilm;
  film->type = "hdrfilm";
  film->where = sensor->where;
  if (const auto old = first_child(*sensor, Category::kFilm)) *film = *old;
  if (std::erase_if(film->values, [](const NamedValue& value) { return value.name.starts_with("crop_"); }) > 0)
    log_notice("--size: the crop window of the scene's film is dropped");
  set_value(*film, "width", std::to_string(size.x));
  set_value(*film, "height", std::to_string(size.y));
  document.root = with_child(*document.root, with_child(*sensor, film));
}

/// Puts the integrator of --integrator in the place of the scene's, before anything is made: its scene_unit counts for
/// media.
void set_integrator(SceneDocument& document, const std::string& text) {
  std::vector<std::pair<std::string, std::string>> settings;
  const std::string type = text.substr(0, text.find(','));
  for (size_t at = type.size(); at < text.size();) {
    const size_t end = std::min(text.find(',', at + 1), text.size());
    settings.push_back(read_assignment(text.substr(at + 1, end - at - 1), "--integrator"));
    at = end;
  }
  IntegratorReplacement replacement;
  try {
    replacement = replace_integrator(find_integrator(document), type, settings);
    make_integrator(replacement.description, &document);
  } catch (const SceneError& error) {
    if (!error.where().file.empty()) throw;
    throw UsageError("--integrator: " + error.reason());
  }
  for (const std::string& name : replacement.dropped)
    log_notice(fmt::format("--integrator: '{}' of the scene's integrator is dropped, {} has none", name, type));
  document.root = with_child(*document.root, replacement.description.node);
}

std::string describe_value(const Value& value) {
  if (const auto* text = std::get_if<UntypedText>(&value)) return text->text;
  if (const auto* boolean = std::get_if<bool>(&value)) return *boolean ? "true" : "false";
  if (const auto* integer = std::get_if<int64_t>(&value)) return std::to_string(*integer);
  if (const auto* number = std::get_if<double>(&value)) return fmt::format("{}", *number);
  if (const auto* string = std::get_if<std::string>(&value)) return *string;
  return "...";
}

}  // namespace

SceneDocument read_chosen(const SceneChoice& choice) {
  const Overrides overrides = read_definitions(choice.definitions);
  SceneDocument document = choice.file.empty()
                               ? read_document_from_string(std::string(default_scene()), choice.name(), overrides)
                               : read_document(choice.file, overrides);
  if (!choice.size.empty()) set_film_size(document, read_size(choice.size));
  if (!choice.integrator.empty()) set_integrator(document, choice.integrator);
  return document;
}

LoadedScene open_scene(const SceneChoice& choice) { return load_scene(read_chosen(choice)); }

uint64_t scene_fingerprint(const SceneChoice& choice, const std::vector<std::filesystem::path>& files, uint64_t seed) {
  uint64_t hash = seed;
  const auto add = [&hash](std::string_view text) { hash = hash_bytes(text, hash); };
  add(version());
  add(version_commit());
  if (choice.file.empty()) add(default_scene());
  for (const std::filesystem::path& file : files)
    if (std::filesystem::exists(file)) add(read_file(file.string()));
  for (const std::string& definition : choice.definitions) add(definition);
  add(choice.integrator);
  add(choice.size);
  return hash;
}

std::string describe_integrator(const SceneNode& node) {
  std::string text = node.type;
  const auto inner = first_child(node, Category::kIntegrator);
  if (inner) text += "(" + describe_integrator(*inner);
  for (const NamedValue& value : node.values) text += " " + value.name + "=" + describe_value(value.value);
  return inner ? text + ")" : text;
}

}  // namespace turbid
