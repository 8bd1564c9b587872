#include "scene/legacy.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "core/log.h"
#include "scene/values.h"

namespace turbid {
namespace {

/// A plugin of 0.6 and what it is called here. `note` tells what changes; empty where it is the same thing.
struct Renamed {
  Category category;
  const char *old_type, *new_type, *note;
};
constexpr Renamed kRenamed[] = {
    {Category::kFilm, "ldrfilm", "hdrfilm", "the picture is linear, and a tone-mapped PNG lies beside it"},
    {Category::kFilm, "tiledhdrfilm", "hdrfilm", ""},
    {Category::kSampler, "halton", "sobol", "other well-spread points"},
    {Category::kSampler, "hammersley", "sobol", "other well-spread points"},
    {Category::kIntegrator, "volpath_simple", "volpath", "the same picture with less noise"},
};

/// A parameter of 0.6 that is called something else here.
struct RenamedParameter {
  Category category;
  const char *type, *old_name, *new_name;
};
constexpr RenamedParameter kRenamedParameters[] = {
    {Category::kBsdf, "diffuse", "diffuse_reflectance", "reflectance"},
    {Category::kMedium, "heterogeneous", "density", "sigma_t"},
};

/// A parameter of 0.6 that is left out here, and why. Type "": of all plugins of the category.
struct Dropped {
  Category category;
  const char *type, *name, *why;
};
constexpr const char* kNotNeeded = "";  // nothing that anybody would miss
constexpr Dropped kDropped[] = {
    {Category::kFilm, "", "banner", kNotNeeded},
    {Category::kFilm, "", "attach_log", kNotNeeded},
    {Category::kFilm, "", "high_quality_edges", kNotNeeded},
    {Category::kFilm, "", "tile_size", kNotNeeded},
    {Category::kFilm, "", "gamma", "the picture is linear"},
    {Category::kFilm, "", "tonemap_method", "--exposure brightens the PNG"},
    {Category::kFilm, "", "exposure", "--exposure brightens the PNG"},
    {Category::kFilm, "", "key", "--exposure brightens the PNG"},
    {Category::kFilm, "", "burn", "--exposure brightens the PNG"},
    {Category::kSampler, "", "dimension", kNotNeeded},
    {Category::kSampler, "", "scramble", kNotNeeded},
    {Category::kIntegrator, "", "strict_normals", "normals are always treated strictly"},
    {Category::kShape, "", "max_smooth_angle", "normals are taken from the file"},
    {Category::kShape, "", "collapse", kNotNeeded},
    {Category::kMedium, "", "strategy", kNotNeeded},
    {Category::kMedium, "", "method", kNotNeeded},
    {Category::kMedium, "", "step_size", kNotNeeded},
    {Category::kMedium, "", "medium_sampling_weight", kNotNeeded},
    {Category::kVolume, "", "send_data", kNotNeeded},
    {Category::kTexture, "bitmap", "max_anisotropy", kNotNeeded},
    {Category::kTexture, "bitmap", "cache", kNotNeeded},
    {Category::kEmitter, "envmap", "cache", kNotNeeded},
};

NamedValue* find_value(SceneNode& node, const std::string& name) {
  for (NamedValue& value : node.values)
    if (value.name == name) return &value;
  return nullptr;
}

/// uscale, vscale, uoffset, voffset as one to_uv, which maps uv to scale x uv + offset, as in Mitsuba 0.6. (Mitsuba 3's
/// upgrade scales the offset too.)
void gather_to_uv(SceneNode& node) {
  SourceLocation where;
  const auto take = [&](const char* name, double otherwise) {
    const NamedValue* value = find_value(node, name);
    if (!value) return otherwise;
    where = value->where;
    if (const auto* number = std::get_if<double>(&value->value)) otherwise = *number;
    if (const auto* integer = std::get_if<int64_t>(&value->value)) otherwise = static_cast<double>(*integer);
    std::erase_if(node.values, [&](const NamedValue& v) { return v.name == name; });
    return otherwise;
  };
  const double uscale = take("uscale", 1), vscale = take("vscale", 1);
  const double uoffset = take("uoffset", 0), voffset = take("voffset", 0);
  if (where.line == 0 && where.file.empty()) return;
  if (uscale == 0 || vscale == 0) throw SceneError(where, "'uscale' and 'vscale' must not be 0");
  const Transform to_uv = Transform::translate(uoffset, voffset, 0) * Transform::scale(uscale, vscale, 1);
  node.values.push_back({"to_uv", to_uv, where, where});
}

/// The sRGB transfer function of IEC 61966-2-1, decoded.
double from_srgb(double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); }

/// <srgb value="r, g, b"> as linear RGB; #rrggbb is encoded already. Anything else keeps its tag, and is refused later.
void upgrade_srgb(pugi::xml_node tag) {
  pugi::xml_attribute value = tag.attribute("value");
  const std::string text = value.value();
  if (!text.starts_with('#')) {
    try {
      std::string linear;
      for (const double v : read_numbers(text, {})) linear += fmt::format("{} ", from_srgb(v));
      value.set_value(linear.c_str());
    } catch (const SceneError&) {
      return;
    }
  }
  tag.set_name("rgb");
}

}  // namespace

std::string snake_case(const std::string& camel_case) {
  const auto is_upper = [](char c) { return std::isupper(static_cast<unsigned char>(c)) != 0; };
  const auto is_lower = [](char c) { return std::islower(static_cast<unsigned char>(c)) != 0; };
  std::string result;
  bool hump = false;  // within capitals that follow a small letter
  for (size_t i = 0; i < camel_case.size(); ++i) {
    const char c = camel_case[i];
    if (i > 0 && is_upper(c) && is_lower(camel_case[i - 1])) {
      result += '_';
      hump = true;
    }
    hump = hump && is_upper(c);
    result += hump ? static_cast<char>(std::tolower(static_cast<unsigned char>(c))) : c;
  }
  return result;
}

void LegacyUpgrade::upgrade_tags(pugi::xml_node node, int depth) {
  constexpr int kDeepest = 1000;  // the reader refuses less
  if (depth > kDeepest) return;
  // Only names of the same length or shorter are set on tags: those keep their place in the text for messages.
  const std::string tag = node.name();
  if (tag != "default")
    if (pugi::xml_attribute name = node.attribute("name")) name.set_value(snake_case(name.value()).c_str());
  if (tag == "lookAt") node.set_name("lookat");
  if (tag == "srgb") upgrade_srgb(node);
  // Numbers without wavelengths were RGB in the usual build of 0.6.
  const std::string_view value = node.attribute("value").value();
  if (tag == "spectrum" && !value.empty() && value.find_first_of(":$") == std::string_view::npos) node.set_name("rgb");
  for (const pugi::xml_node& child : node.children())
    if (child.type() == pugi::node_element) upgrade_tags(child, depth + 1);
}

void LegacyUpgrade::upgrade_node(SceneNode& node) {
  for (const RenamedParameter& renamed : kRenamedParameters) {
    if (renamed.category != node.category || renamed.type != node.type) continue;
    if (NamedValue* value = find_value(node, renamed.old_name)) value->name = renamed.new_name;
    for (Child& child : node.children)
      if (child.name == renamed.old_name) child.name = renamed.new_name;
  }
  if (node.category == Category::kTexture) gather_to_uv(node);
  if (node.category == Category::kTexture && node.type == "bitmap") upgrade_bitmap(node);
  drop_parameters(node);
  rename_plugin(node);
}

void LegacyUpgrade::rename_plugin(SceneNode& node) {
  for (const Renamed& renamed : kRenamed) {
    if (renamed.category != node.category || renamed.old_type != node.type) continue;
    const std::string note = renamed.note;
    if (!note.empty()) say_once(fmt::format("{} is read as '{}': {}", node.describe(), renamed.new_type, note));
    node.type = renamed.new_type;
    return;
  }
}

void LegacyUpgrade::drop_parameters(SceneNode& node) {
  for (const Dropped& dropped : kDropped) {
    const std::string type = dropped.type, why = dropped.why;
    if (dropped.category != node.category || (!type.empty() && type != node.type)) continue;
    const auto count = std::erase_if(node.values, [&](const NamedValue& value) { return value.name == dropped.name; });
    if (count > 0 && !why.empty())
      say_once(fmt::format("'{}' of {} is dropped: {}", dropped.name, node.describe(), why));
  }
}

/// Filters that need derivatives of the view become the nearest one that does not; gamma 1 means plain numbers.
void LegacyUpgrade::upgrade_bitmap(SceneNode& node) {
  if (NamedValue* filter = find_value(node, "filter_type")) {
    auto* name = std::get_if<std::string>(&filter->value);
    if (name && (*name == "ewa" || *name == "trilinear")) *name = "bilinear";
  }
  const NamedValue* gamma = find_value(node, "gamma");
  if (!gamma) return;
  const auto* number = std::get_if<double>(&gamma->value);
  const SourceLocation where = gamma->where;
  if (number && *number == 1)
    node.values.push_back({"raw", true, where, where});
  else if (number && *number != -1)
    throw SceneError(where, fmt::format("a gamma of {} is not supported, only 1 (plain numbers) or none (as the file "
                                        "says, usually sRGB)",
                                        *number));
  std::erase_if(node.values, [](const NamedValue& value) { return value.name == "gamma"; });
}

void LegacyUpgrade::say_once(const std::string& message) {
  if (said_.insert(message).second) log_notice(message);
}

}  // namespace turbid
