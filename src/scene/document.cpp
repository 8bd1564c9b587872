#include "scene/document.h"

#include <algorithm>

namespace turbid {

const char* to_string(Category category) {
  switch (category) {
    case Category::kScene:
      return "scene";
    case Category::kShape:
      return "shape";
    case Category::kBsdf:
      return "bsdf";
    case Category::kEmitter:
      return "emitter";
    case Category::kMedium:
      return "medium";
    case Category::kPhase:
      return "phase";
    case Category::kTexture:
      return "texture";
    case Category::kVolume:
      return "volume";
    case Category::kSensor:
      return "sensor";
    case Category::kFilm:
      return "film";
    case Category::kSampler:
      return "sampler";
    case Category::kFilter:
      return "rfilter";
    case Category::kIntegrator:
      return "integrator";
  }
  return "?";
}

std::string describe_type(const Value& value) {
  static constexpr const char* kNames[] = {"a text",   "a boolean", "an integer", "a float",
                                           "a string", "a vector",  "a spectrum", "a transform"};
  return kNames[value.index()];
}

bool describe_the_same(const SceneNode& a, const SceneNode& b) {
  const auto same_value = [](const NamedValue& v, const NamedValue& w) {
    return v.name == w.name && v.value == w.value;
  };
  const auto same_child = [](const Child& v, const Child& w) {
    return v.name == w.name && (v.node == w.node || describe_the_same(*v.node, *w.node));
  };
  return a.category == b.category && a.type == b.type && std::ranges::equal(a.values, b.values, same_value) &&
         std::ranges::equal(a.children, b.children, same_child);
}

bool file_exists(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::exists(path, ignored);
}

std::filesystem::path SceneDocument::resolve(const std::string& name) const {
  const std::filesystem::path path(name);
  if (path.is_absolute()) return path;
  for (const auto& folder : search_folders)
    if (file_exists(folder / path)) return (folder / path).lexically_normal();
  return path;
}

}  // namespace turbid
