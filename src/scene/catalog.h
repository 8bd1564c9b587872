#pragma once
#include "scene/plugin.h"

namespace turbid {

/// A plugin without its maker: what `turbid list` and the reference documentation show.
struct PluginDescription {
  std::string name;
  std::vector<std::string> aliases;
  std::string summary;
  std::vector<Parameter> parameters;
};

/// All plugins of a category.
struct CategoryDescription {
  Category category;
  std::string title;  ///< plural, as in `turbid list bsdfs`
  std::vector<PluginDescription> plugins;
};

/// Describes any plugin table.
template <class Product, class... Context>
CategoryDescription describe_table(const PluginTable<Product, Context...>& table, std::string title) {
  CategoryDescription result{table.category(), std::move(title), {}};
  for (const auto& row : table.rows()) result.plugins.push_back({row.name, row.aliases, row.summary, row.parameters});
  return result;
}

/// Every category of the scene room: shapes, bsdfs, textures, emitters, media, phases, sensors, films, samplers,
/// filters. Integrators are described by their own room with describe_table.
std::vector<CategoryDescription> plugin_catalog();

}  // namespace turbid
