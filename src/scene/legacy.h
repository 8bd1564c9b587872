#pragma once
#include <pugixml.hpp>
#include <set>

#include "scene/document.h"

namespace turbid {

/// Turns scenes of Mitsuba 0.4 to 0.6 into today's.
///
/// As Mitsuba 3's own upgrade: camelCase names of parameters become snake_case (toWorld -> to_world, intIOR ->
/// int_ior), lookAt -> lookat, diffuseReflectance -> reflectance, uoffset, voffset, uscale and vscale -> to_uv. Beyond
/// it, so that the scene means what it meant there: colours given as one or three numbers stay RGB, plugins that have
/// another name today get that (ldrfilm, halton, volpath_simple ...), and parameters that say nothing about light here
/// are dropped. Everything that is not just a name is said in a notice, once.
class LegacyUpgrade {
 public:
  /// Names of tags and values, in place, before anything is read.
  void upgrade_tags(pugi::xml_node node, int depth = 0);
  /// A plugin that has been read, with its children.
  void upgrade_node(SceneNode& node);

 private:
  void rename_plugin(SceneNode& node);
  void drop_parameters(SceneNode& node);
  void upgrade_bitmap(SceneNode& node);
  void say_once(const std::string& message);

  std::set<std::string> said_;
};

/// camelCase to snake_case: "toWorld" -> "to_world", "intIOR" -> "int_ior".
std::string snake_case(const std::string& camel_case);

}  // namespace turbid
