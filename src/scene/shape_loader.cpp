// The part of SceneLoader that makes the shapes, those of groups and their instances included.
#include <exception>

#include "core/parallel.h"
#include "geometry/instance.h"
#include "scene/scene_loader.h"
#include "scene/shape_tree.h"

namespace turbid {

std::map<const SceneNode*, std::shared_ptr<const Shape>> SceneLoader::make_shapes(
    const std::vector<const SceneNode*>& nodes) {
  // Files are read in parallel; of several errors the first in the file is reported.
  std::vector<std::shared_ptr<const Shape>> shapes(nodes.size());
  std::vector<std::exception_ptr> errors(nodes.size());
  parallel_for(nodes.size(), [&](size_t i) {
    try {
      shapes[i] = shape_table().make(*nodes[i], document_.get(), builder_);
    } catch (...) {
      errors[i] = std::current_exception();
    }
  });
  for (const std::exception_ptr& error : errors)
    if (error) std::rethrow_exception(error);
  std::map<const SceneNode*, std::shared_ptr<const Shape>> result;
  for (size_t i = 0; i < nodes.size(); ++i) result[nodes[i]] = std::move(shapes[i]);
  return result;
}

void SceneLoader::place_instance(const SceneNode& node, const std::shared_ptr<const ShapeGroup>& group,
                                 const std::vector<Object>& materials) {
  const Properties p(node, shape_table().row_of(node).parameters, document_.get());
  std::vector<std::shared_ptr<const Shape>> placed;
  try {
    placed = place_group(group, p.transform("to_world"));
  } catch (const std::invalid_argument& error) {
    throw SceneError(p.where("to_world"), error.what());
  }
  for (size_t i = 0; i < placed.size(); ++i) {
    Object object = materials[i];
    object.shape = std::move(placed[i]);
    parts_.objects.push_back(std::move(object));
  }
}

void SceneLoader::load_shapes() {
  const ShapeTree tree(*document_);
  const auto shapes = make_shapes(tree.shapes());
  struct Group {
    std::shared_ptr<const ShapeGroup> shapes;
    std::vector<Object> materials;  ///< of the members
  };
  std::map<const SceneNode*, Group> groups;
  for (const ShapeTree::Group& declared : tree.groups()) {
    ShapeGroup members;
    Group& group = groups[declared.node];
    for (const SceneNode* member : declared.members) {
      members.members.push_back(shapes.at(member));
      group.materials.push_back(assemble(*member, shapes.at(member)));
      if (group.materials.back().emitter)
        throw SceneError(member->where, member->describe() + " cannot shine in a shapegroup: lights have no instances");
    }
    group.shapes = std::make_shared<const ShapeGroup>(std::move(members));
  }
  for (const ShapeTree::Item& item : tree.items()) {
    if (item.group)
      place_instance(*item.node, groups.at(item.group).shapes, groups.at(item.group).materials);
    else
      parts_.objects.push_back(assemble(*item.node, shapes.at(item.node)));
  }
}

}  // namespace turbid
