#pragma once
#include <mutex>
#include <unordered_map>

#include "scene/tables.h"

namespace turbid {

/// Makes the objects of a scene from its nodes; a node that is referred to many times is made once. Makers in the
/// tables use it to get what their parameters refer to.
class Builder {
 public:
  /// `metres_per_unit`: size of a scene unit, 0 when the scene does not say.
  Builder(const SceneDocument& document, double metres_per_unit)
      : document_(&document), metres_per_unit_(metres_per_unit) {}

  const SceneDocument& document() const { return *document_; }
  double metres_per_unit() const { return metres_per_unit_; }

  std::shared_ptr<const Bsdf> bsdf(const SceneNode& node);
  /// Textures, and volumes that are the same everywhere.
  std::shared_ptr<const Texture> texture(const SceneNode& node);
  std::shared_ptr<const Volume> volume(const SceneNode& node);
  std::shared_ptr<const Medium> medium(const SceneNode& node);
  std::shared_ptr<const PhaseFunction> phase(const SceneNode& node);

  /// A kTexture parameter: the texture inside, or a constant one of the value or the default; null when it is left out
  /// and has no default.
  std::shared_ptr<const Texture> texture(const Properties& properties, const std::string& name);
  /// A kTexture parameter of something that fills space: the volume inside, or a constant one; null as above.
  std::shared_ptr<const Volume> volume(const Properties& properties, const std::string& name);
  /// A kSpectrum parameter: a value, or the value of a texture or volume inside, which must be the same everywhere.
  Spectrum spectrum(const Properties& properties, const std::string& name);
  /// The plugin inside, or null.
  std::shared_ptr<const Bsdf> bsdf(const Properties& properties, const std::string& name);
  std::shared_ptr<const Medium> medium(const Properties& properties, const std::string& name);
  std::shared_ptr<const PhaseFunction> phase(const Properties& properties, const std::string& name);

  /// The picture texture made by `make`, or the one made before under the same key (its file and settings).
  std::shared_ptr<const Texture> picture(const std::string& key,
                                         const std::function<std::shared_ptr<const Texture>()>& make);

  /// The file that a kFile parameter names; remembered as read. Safe to call from several threads.
  std::string file(const Properties& properties, const std::string& name);
  const std::vector<std::filesystem::path>& files() const { return files_; }

 private:
  template <class T>
  using Cache = std::unordered_map<const SceneNode*, std::shared_ptr<const T>>;
  template <class T, class Table>
  std::shared_ptr<const T> once(Cache<T>& cache, const Table& table, const SceneNode& node);

  const SceneDocument* document_;
  double metres_per_unit_;
  Cache<Bsdf> bsdfs_;
  Cache<Texture> textures_;
  Cache<Volume> volumes_;
  Cache<Medium> media_;
  Cache<PhaseFunction> phases_;
  std::map<std::string, std::shared_ptr<const Texture>> pictures_;
  std::mutex files_mutex_;
  std::vector<std::filesystem::path> files_;
};

}  // namespace turbid
