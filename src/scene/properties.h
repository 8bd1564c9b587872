#pragma once
#include <map>

#include "scene/parameter.h"

namespace turbid {

/// The parameters of one plugin: what the file says, checked against the plugin's list, and the list's defaults.
///
/// The constructor reports everything that the list does not know, all at once, with the nearest names; values of the
/// wrong type or out of range; missing required ones. So a maker only asks. Asking for a name that is not in the list
/// is a mistake in the program and throws std::logic_error.
class Properties {
 public:
  Properties(const SceneNode& node, const std::vector<Parameter>& list, const SceneDocument* document = nullptr);

  const SceneNode& node() const { return *node_; }
  /// Does the file (or command line) give it?
  bool has(const std::string& name) const;
  /// Is it given, or does it have a default?
  bool has_value(const std::string& name) const;
  /// Where it is given, or the plugin itself.
  SourceLocation where(const std::string& name) const;

  bool boolean(const std::string& name) const;
  int64_t integer(const std::string& name) const;
  float number(const std::string& name) const;
  std::string string(const std::string& name) const;
  /// The file that a kFile parameter names, found in the search folders. Throws SceneError when it does not exist.
  std::filesystem::path file(const std::string& name) const;
  Vec3 vector(const std::string& name) const;  ///< points too
  Spectrum spectrum(const std::string& name) const;
  /// Refuses a spectrum (from a constant texture, say) that is out of the parameter's range.
  void check_range(const std::string& name, const Spectrum& spectrum) const;
  Transform transform(const std::string& name) const;
  /// True when the value is a string rather than a number (kIor, kFloatOrString).
  bool is_string(const std::string& name) const;

  /// The plugin inside given for this parameter, or null.
  const SceneNode* child(const std::string& name) const;

  /// Refuses the parameter's value, where the file gives it: "'g' of phase 'hg' <message>".
  [[noreturn]] void refuse(const std::string& name, const std::string& message) const;

 private:
  struct Given {
    const NamedValue* value = nullptr;
    const Child* child = nullptr;
  };

  const Parameter& parameter(const std::string& name) const;
  /// The value given, or the default, in the parameter's type.
  Value value(const Parameter& parameter) const;
  const Parameter* parameter_for(const Child& child) const;
  void match_values();
  void match_children();
  void report_unknown() const;
  void check(const Parameter& parameter) const;

  const SceneNode* node_;
  const std::vector<Parameter>* list_;
  const SceneDocument* document_;
  std::map<std::string, Given> given_;
  struct Unknown {
    std::string what, name;
    SourceLocation where;
  };
  std::vector<Unknown> unknown_;
};

}  // namespace turbid
