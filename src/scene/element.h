#pragma once
#include <initializer_list>
#include <pugixml.hpp>
#include <string>

#include "scene/source_text.h"
#include "scene/variables.h"

namespace turbid {

/// An XML tag while it is read: its attributes with $variables replaced, and where they stand.
class Element {
 public:
  Element(const pugi::xml_node& node, const SourceText& source, Variables& variables)
      : node_(node), source_(&source), variables_(&variables) {}

  const pugi::xml_node& node() const { return node_; }
  std::string tag() const { return node_.name(); }
  /// A tag of the same file.
  Element element(const pugi::xml_node& node) const { return {node, *source_, *variables_}; }
  SourceLocation where() const;
  SourceLocation where(const char* attribute) const;

  bool has(const char* attribute) const { return !node_.attribute(attribute).empty(); }
  /// The attribute's text; empty when it is not there.
  std::string get(const char* attribute) const;

  /// Refuses the tag when a required attribute is missing or there is one that is neither required nor optional.
  void check_attributes(std::initializer_list<const char*> required,
                        std::initializer_list<const char*> optional = {}) const;
  /// Refuses tags inside this one, and text.
  void check_empty() const;

  [[noreturn]] void refuse(const std::string& message) const { throw SceneError(where(), message); }

 private:
  pugi::xml_node node_;
  const SourceText* source_;
  Variables* variables_;
};

}  // namespace turbid
