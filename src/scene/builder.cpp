#include "scene/builder.h"

#include "texture/constant.h"
#include "texture/constant_volume.h"

namespace turbid {

template <class T, class Table>
std::shared_ptr<const T> Builder::once(Cache<T>& cache, const Table& table, const SceneNode& node) {
  if (const auto made = cache.find(&node); made != cache.end()) return made->second;
  return cache[&node] = table.make(node, document_, *this);
}

std::shared_ptr<const Bsdf> Builder::bsdf(const SceneNode& node) { return once<Bsdf>(bsdfs_, bsdf_table(), node); }
std::shared_ptr<const Medium> Builder::medium(const SceneNode& node) {
  // Media are told apart by their objects: fog that is written out on both sides of a boundary must be one.
  for (const auto& [other, made] : media_)
    if (describe_the_same(*other, node)) return made;
  return once<Medium>(media_, medium_table(), node);
}
std::shared_ptr<const PhaseFunction> Builder::phase(const SceneNode& node) {
  return once<PhaseFunction>(phases_, phase_table(), node);
}
std::shared_ptr<const Texture> Builder::texture(const SceneNode& node) {
  if (node.category != Category::kVolume) return once<Texture>(textures_, texture_table(), node);
  const auto constant = std::dynamic_pointer_cast<const ConstantVolume>(volume(node));
  if (!constant) throw SceneError(node.where, node.describe() + " varies in space: this parameter takes no such thing");
  return std::make_shared<ConstantTexture>(constant->value());
}
std::shared_ptr<const Volume> Builder::volume(const SceneNode& node) {
  return once<Volume>(volumes_, volume_table(), node);
}

std::shared_ptr<const Texture> Builder::texture(const Properties& properties, const std::string& name) {
  if (const SceneNode* node = properties.child(name)) {
    const auto made = texture(*node);
    if (made->is_constant()) properties.check_range(name, made->mean());
    return made;
  }
  if (!properties.has_value(name)) return nullptr;
  return std::make_shared<ConstantTexture>(properties.spectrum(name));
}

std::shared_ptr<const Volume> Builder::volume(const Properties& properties, const std::string& name) {
  const SceneNode* node = properties.child(name);
  if (node && node->category == Category::kVolume) {
    const auto made = volume(*node);
    if (const auto constant = std::dynamic_pointer_cast<const ConstantVolume>(made))
      properties.check_range(name, constant->value());
    return made;
  }
  if (!node && !properties.has_value(name)) return nullptr;
  return std::make_shared<ConstantVolume>(spectrum(properties, name));
}

Spectrum Builder::spectrum(const Properties& properties, const std::string& name) {
  const SceneNode* node = properties.child(name);
  if (!node) return properties.spectrum(name);
  const auto made = texture(*node);
  if (!made->is_constant()) properties.refuse(name, "must be the same everywhere, found a texture that varies");
  properties.check_range(name, made->mean());
  return made->mean();
}

std::shared_ptr<const Bsdf> Builder::bsdf(const Properties& properties, const std::string& name) {
  const SceneNode* node = properties.child(name);
  return node ? bsdf(*node) : nullptr;
}
std::shared_ptr<const Medium> Builder::medium(const Properties& properties, const std::string& name) {
  const SceneNode* node = properties.child(name);
  return node ? medium(*node) : nullptr;
}
std::shared_ptr<const PhaseFunction> Builder::phase(const Properties& properties, const std::string& name) {
  const SceneNode* node = properties.child(name);
  return node ? phase(*node) : nullptr;
}

std::shared_ptr<const Texture> Builder::picture(const std::string& key,
                                                const std::function<std::shared_ptr<const Texture>()>& make) {
  if (const auto made = pictures_.find(key); made != pictures_.end()) return made->second;
  return pictures_[key] = make();
}

std::string Builder::file(const Properties& properties, const std::string& name) {
  const std::filesystem::path path = properties.file(name);
  const std::lock_guard lock(files_mutex_);
  files_.push_back(path);
  return path.string();
}

}  // namespace turbid
