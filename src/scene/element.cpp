#include "scene/element.h"

#include "scene/suggestions.h"

namespace turbid {

SourceLocation Element::where() const {
  const auto name = static_cast<size_t>(node_.offset_debug());
  return source_->locate(name > 0 ? name - 1 : 0);  // the "<"
}

SourceLocation Element::where(const char* attribute) const {
  return source_->locate_attribute(static_cast<size_t>(node_.offset_debug()), attribute);
}

std::string Element::get(const char* attribute) const {
  const std::string text = node_.attribute(attribute).value();
  return text.find('$') == std::string::npos ? text : variables_->substitute(text, where(attribute));
}

void Element::check_attributes(std::initializer_list<const char*> required,
                               std::initializer_list<const char*> optional) const {
  std::vector<std::string> known(required.begin(), required.end());
  known.insert(known.end(), optional.begin(), optional.end());
  for (const pugi::xml_attribute& attribute : node_.attributes()) {
    const std::string name = attribute.name();
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw SceneError(where(), "unknown attribute '" + name + "' of <" + tag() + ">" + suggestion(name, known));
  }
  for (const char* name : required)
    if (!has(name)) refuse("<" + tag() + "> needs the attribute '" + std::string(name) + "'");
}

void Element::check_empty() const {
  for (const pugi::xml_node& child : node_.children()) {
    if (child.type() == pugi::node_element)
      element(child).refuse("<" + std::string(child.name()) + "> cannot stand inside <" + tag() + ">");
    if (child.type() == pugi::node_pcdata || child.type() == pugi::node_cdata)
      refuse("<" + tag() + "> cannot contain text: values are written in attributes");
  }
}

}  // namespace turbid
