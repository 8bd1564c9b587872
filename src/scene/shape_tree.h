#pragma once
#include <set>
#include <vector>

#include "scene/document.h"

namespace turbid {

/// The shapes of a scene with their containers opened: `merge` is transparent, a `shapegroup` is seen through its
/// instances only.
class ShapeTree {
 public:
  /// Throws SceneError: wrong parameters of containers, groups or instances inside groups.
  explicit ShapeTree(const SceneDocument& document);

  /// Something that is seen: a shape, or (group not null) all members of a group where the instance `node` puts them.
  struct Item {
    const SceneNode* node;
    const SceneNode* group;
  };
  struct Group {
    const SceneNode* node;
    std::vector<const SceneNode*> members;
  };

  /// Every shape that must be made, seen or in a group, each once, in the order of the file.
  const std::vector<const SceneNode*>& shapes() const { return shapes_; }
  const std::vector<Group>& groups() const { return groups_; }
  const std::vector<Item>& items() const { return items_; }

 private:
  using Nodes = std::set<const SceneNode*>;

  void visit_children(const SceneNode& parent, Nodes& seen, Group* group);
  void visit(const SceneNode& node, Nodes& seen, Group* group);
  const SceneNode* open_group(const SceneNode& node);
  const SceneNode* group_of(const SceneNode& instance);
  /// The parameters of a container that are not shapes.
  void check(const SceneNode& container) const;
  void remember(const SceneNode& shape);

  const SceneDocument& document_;
  std::vector<const SceneNode*> shapes_;
  Nodes known_shapes_;
  std::vector<Group> groups_;
  Nodes known_groups_;
  std::vector<Item> items_;
};

}  // namespace turbid
