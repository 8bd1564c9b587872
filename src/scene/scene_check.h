#pragma once
#include <string>
#include <vector>

#include "scene/scene.h"

namespace turbid {

/// What in a scene is probably not meant, in words, for `turbid info`: boundaries of media that are open, inside out,
/// opaque or coarse for their medium; sensors whose medium does not fit the shapes around them. Empty when nothing is
/// suspicious.
std::vector<std::string> check_scene(const Scene& scene);

/// An object's name in messages: its id, or its place among the shapes, counted from 1.
std::string name_of(const Scene& scene, const Object& object);

/// True when a closed shape shows its inside to the outside world: flipped normals, which turn its media inside out.
bool is_inside_out(const Scene& scene, const Object& object);

/// The longest edge of a mesh's triangles; 0 for shapes without triangles.
float longest_edge(const Shape& shape);

}  // namespace turbid
