#pragma once
#include "geometry/shape.h"
#include "scene/document.h"

namespace turbid {

/// Refuses (SceneError, at the texture) what asks, anywhere below the node of a shape, for a mesh attribute that the
/// shape does not have.
void check_mesh_attributes(const SceneNode& node, const Shape& shape);

}  // namespace turbid
