#include "scene/index_reader.h"

#include "scene/suggestions.h"
#include "surface/indices.h"

namespace turbid {

float index_of(const Properties& p, const std::string& name) {
  if (!p.is_string(name)) return p.number(name);
  const std::string material = p.string(name);
  if (const auto index = find_index(material)) return *index;
  std::vector<std::string> names;
  for (const NamedIndex& known : named_indices()) names.push_back(known.name);
  p.refuse(name, "names the unknown material '" + material + "'" + suggestion(material, names));
}

}  // namespace turbid
