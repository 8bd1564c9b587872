#include "scene/variables.h"

#include <cctype>

#include "scene/suggestions.h"

namespace turbid {

void Variables::set_default(const std::string& name, const std::string& value) {
  declared_.insert(name);
  values_.emplace(name, value);
}

std::string Variables::substitute(const std::string& text, const SourceLocation& where) {
  std::string result;
  size_t at = 0;
  for (size_t dollar; (dollar = text.find('$', at)) != std::string::npos;) {
    result += text.substr(at, dollar - at);
    const std::string rest = text.substr(dollar + 1);
    const std::pair<const std::string, std::string>* longest = nullptr;
    for (const auto& variable : values_)
      if (rest.starts_with(variable.first) && (!longest || variable.first.size() > longest->first.size()))
        longest = &variable;
    if (!longest) {
      size_t end = 0;
      while (end < rest.size() && (std::isalnum(static_cast<unsigned char>(rest[end])) || rest[end] == '_')) ++end;
      std::vector<std::string> names;
      for (const auto& [name, value] : values_) names.push_back(name);
      throw SceneError(where, "undefined variable $" + rest.substr(0, end) + suggestion(rest.substr(0, end), names));
    }
    result += longest->second;
    used_.insert(longest->first);
    at = dollar + 1 + longest->first.size();
  }
  return result + text.substr(at);
}

void Variables::require_all_overrides_used(const std::string& file) const {
  std::vector<std::string> known(used_.begin(), used_.end());
  for (const std::string& name : declared_)
    if (!used_.contains(name)) known.push_back(name);
  std::erase_if(known, [&](const std::string& name) { return overrides_.contains(name) && !declared_.contains(name); });
  for (const auto& [name, value] : overrides_)
    if (!used_.contains(name) && !declared_.contains(name))
      throw SceneError({file, 0, 0},
                       "-D " + name + "=" + value + ": the scene has no variable $" + name + suggestion(name, known));
}

}  // namespace turbid
