#pragma once
#include <set>
#include <string>

#include "scene/document.h"

namespace turbid {

/// The $variables of a scene: from the command line, which wins, and from <default>.
class Variables {
 public:
  explicit Variables(const Overrides& overrides) : values_(overrides), overrides_(overrides) {}

  /// <default>: a value for a name that has none yet.
  void set_default(const std::string& name, const std::string& value);

  /// Replaces every $name in the text; of the names that fit, the longest wins. Throws SceneError at `where` for a name
  /// that nobody has set.
  std::string substitute(const std::string& text, const SourceLocation& where);

  /// Throws SceneError when a name of the command line was neither used nor declared by the scene.
  void require_all_overrides_used(const std::string& file) const;

 private:
  std::map<std::string, std::string> values_;
  Overrides overrides_;
  std::set<std::string> used_, declared_;
};

}  // namespace turbid
