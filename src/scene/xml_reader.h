#pragma once
#include <deque>

#include "scene/element.h"
#include "scene/legacy.h"
#include "scene/references.h"

namespace turbid {

/// Reads Mitsuba XML into a SceneDocument: variables, includes, paths, references and values are resolved; plugins
/// are not interpreted.
class XmlReader {
 public:
  explicit XmlReader(const Overrides& overrides) : variables_(overrides) {}

  SceneDocument read_file(const std::filesystem::path& path);
  SceneDocument read_text(const std::string& text, const std::string& name, const std::filesystem::path& folder);

 private:
  /// A file that is being read; includes stack up.
  struct File {
    SourceText source;
    std::filesystem::path folder;
    pugi::xml_document xml;
    bool legacy = false;  ///< of Mitsuba 0.x
  };

  SceneDocument finish(File& file);
  File& open(const std::filesystem::path& path);
  File& parse(const std::string& text, const std::string& name, const std::filesystem::path& folder);
  /// The one root tag; checks the version where there is one, and upgrades names of old ones. A file without a version
  /// has that of `includer`.
  Element root_of(File& file, const File* includer);

  void read_children(const Element& element, SceneNode& node, File& file);
  void read_child(const Element& element, SceneNode& node, File& file);
  void read_object(const Element& element, Category category, SceneNode& owner, File& file);
  void read_reference(const Element& element, SceneNode& owner);
  void read_value(const Element& element, SceneNode& owner);
  void read_include(const Element& element, SceneNode& owner, File& file);
  void read_path(const Element& element, const SceneNode& owner, const File& file);
  Value value_of(const Element& element, const SceneNode& owner);
  Spectrum spectrum_of(const Element& element, const SceneNode& owner);
  Transform transform_of(const Element& element);
  /// A file that the scene names: in the search folders, else beside the file that names it, else the name itself.
  std::filesystem::path find_file(const std::string& name, const std::filesystem::path& folder) const;

  Variables variables_;
  References references_;
  SceneDocument document_;
  std::vector<std::filesystem::path> including_;  ///< the chain of files that are being read
  std::deque<File> files_;                        ///< kept for locations
  LegacyUpgrade upgrade_;
  int depth_ = 0;
};

}  // namespace turbid
