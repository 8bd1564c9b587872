#include "scene/attribute_check.h"

#include "geometry/triangle_mesh.h"
#include "scene/tables.h"

namespace turbid {
namespace {

void check(const SceneNode& texture, const SceneNode& shape_node, const Shape& shape) {
  const std::string name = Properties(texture, texture_table().row_of(texture).parameters).string("name");
  std::vector<std::string> known;
  if (const auto* mesh = dynamic_cast<const TriangleMesh*>(&shape)) {
    if (mesh->attribute(name)) return;
    for (const MeshAttribute& attribute : mesh->data().attributes) known.push_back(attribute.name);
  }
  throw SceneError(texture.where, shape_node.describe() + " has no attribute '" + name + "'" +
                                      (known.empty() ? ": it has none" : suggestion(name, known)));
}

void visit(const SceneNode& node, const SceneNode& shape_node, const Shape& shape) {
  for (const Child& child : node.children) {
    if (!child.node) continue;
    if (child.node->category == Category::kTexture && child.node->type == "mesh_attribute")
      check(*child.node, shape_node, shape);
    const bool of_the_surface = child.node->category == Category::kBsdf || child.node->category == Category::kEmitter ||
                                child.node->category == Category::kTexture;
    if (of_the_surface) visit(*child.node, shape_node, shape);
  }
}

}  // namespace

void check_mesh_attributes(const SceneNode& node, const Shape& shape) { visit(node, node, shape); }

}  // namespace turbid
