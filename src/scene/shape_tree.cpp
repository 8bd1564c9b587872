#include "scene/shape_tree.h"

#include "scene/tables.h"

namespace turbid {

ShapeTree::ShapeTree(const SceneDocument& document) : document_(document) {
  Nodes seen;
  visit_children(*document.root, seen, nullptr);
}

void ShapeTree::visit_children(const SceneNode& parent, Nodes& seen, Group* group) {
  for (const Child& child : parent.children)
    if (child.node->category == Category::kShape && seen.insert(child.node.get()).second)
      visit(*child.node, seen, group);
}

void ShapeTree::visit(const SceneNode& node, Nodes& seen, Group* group) {
  if (group && (node.type == "instance" || node.type == "shapegroup"))
    throw SceneError(node.where, node.describe() + " cannot stand in a shapegroup: instances do not nest");
  if (node.type == "merge") {
    check(node);
    visit_children(node, seen, group);
  } else if (node.type == "shapegroup") {
    open_group(node);
  } else if (node.type == "instance") {
    items_.push_back({&node, group_of(node)});
  } else {
    remember(node);
    if (group)
      group->members.push_back(&node);
    else
      items_.push_back({&node, nullptr});
  }
}

void ShapeTree::remember(const SceneNode& shape) {
  if (known_shapes_.insert(&shape).second) shapes_.push_back(&shape);
}

const SceneNode* ShapeTree::open_group(const SceneNode& node) {
  if (!known_groups_.insert(&node).second) return &node;
  check(node);
  Group group{&node, {}};
  Nodes seen;
  visit_children(node, seen, &group);
  groups_.push_back(std::move(group));
  return &node;
}

const SceneNode* ShapeTree::group_of(const SceneNode& instance) {
  const Properties p(instance, shape_table().row_of(instance).parameters, &document_);
  const SceneNode* group = p.child("shapegroup");
  if (group->type != "shapegroup") p.refuse("shapegroup", "must be one, found " + group->describe());
  return open_group(*group);
}

void ShapeTree::check(const SceneNode& container) const {
  SceneNode rest = container;
  std::erase_if(rest.children, [](const Child& child) { return child.node->category == Category::kShape; });
  const Properties checked(rest, shape_table().row_of(container).parameters, &document_);
}

}  // namespace turbid
