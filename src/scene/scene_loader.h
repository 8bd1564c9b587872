#pragma once
#include <map>

#include "geometry/instance.h"
#include "scene/builder.h"
#include "scene/loader.h"

namespace turbid {

/// Turns a document into a LoadedScene.
class SceneLoader {
 public:
  explicit SceneLoader(std::shared_ptr<const SceneDocument> document);

  LoadedScene load();

 private:
  /// The top-level nodes of a category, each once, in the order of the file.
  std::vector<const SceneNode*> nodes(Category category) const;
  void load_shapes();
  /// The shapes of these nodes; their files are read in parallel.
  std::map<const SceneNode*, std::shared_ptr<const Shape>> make_shapes(const std::vector<const SceneNode*>& nodes);
  void place_instance(const SceneNode& node, const std::shared_ptr<const ShapeGroup>& group,
                      const std::vector<Object>& materials);
  void load_world();
  void read_priority(const Properties& shape, Object& object) const;
  Object assemble(const SceneNode& node, std::shared_ptr<const Shape> shape);
  void load_emitters();
  void load_sensor();
  void check_the_rest();
  std::vector<std::filesystem::path> all_files() const;

  std::shared_ptr<const SceneDocument> document_;
  Builder builder_;
  SceneParts parts_;
};

/// Metres per scene unit, from the `scene_unit` of the integrator or of one inside it; 0 when there is none.
double find_scene_unit(const SceneNode& integrator);

}  // namespace turbid
