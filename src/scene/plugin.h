#pragma once
#include <algorithm>
#include <functional>

#include "core/log.h"
#include "scene/properties.h"
#include "scene/suggestions.h"

namespace turbid {

/// A row of a plugin table: everything that turbid knows about a plugin, to be read as documentation. Adding a plugin
/// is writing its class in its room, and a row here. `Context` is what makers need besides their properties.
template <class Product, class... Context>
struct Plugin {
  std::string name;
  std::vector<std::string> aliases{};
  std::string summary;
  std::vector<Parameter> parameters;
  std::function<Product(const Properties&, Context&...)> make;
};

/// All plugins of a category.
template <class Product, class... Context>
class PluginTable {
 public:
  using Row = Plugin<Product, Context...>;

  /// `unsupported`: names that Mitsuba 3 knows and turbid does not, so that a message can say so.
  /// `advice`: what to do without some of them, by name.
  PluginTable(Category category, std::vector<Row> rows, std::vector<std::string> unsupported = {},
              std::map<std::string, std::string> advice = {})
      : category_(category), rows_(std::move(rows)), unsupported_(std::move(unsupported)), advice_(std::move(advice)) {}

  Category category() const { return category_; }
  const std::vector<Row>& rows() const { return rows_; }
  const std::vector<std::string>& unsupported() const { return unsupported_; }

  /// The row of this name or alias, or null.
  const Row* find(const std::string& name) const {
    for (const Row& row : rows_)
      if (row.name == name || std::find(row.aliases.begin(), row.aliases.end(), name) != row.aliases.end()) return &row;
    return nullptr;
  }

  /// All names and aliases.
  std::vector<std::string> names() const {
    std::vector<std::string> result;
    for (const Row& row : rows_) {
      result.push_back(row.name);
      result.insert(result.end(), row.aliases.begin(), row.aliases.end());
    }
    return result;
  }

  /// The row that a node asks for. Throws SceneError with the nearest name when there is none.
  const Row& row_of(const SceneNode& node) const {
    if (const Row* row = find(node.type)) return *row;
    const std::string tag = to_string(category_);
    if (std::find(unsupported_.begin(), unsupported_.end(), node.type) != unsupported_.end())
      throw SceneError(node.where, tag + " '" + node.type + "' is not supported");
    if (const auto advice = advice_.find(node.type); advice != advice_.end())
      throw SceneError(node.where, tag + " '" + node.type + "' is not supported: " + advice->second);
    throw SceneError(node.where, "unknown " + tag + " '" + node.type + "'" + suggestion(node.type, names()));
  }

  /// Makes what a node describes: finds its row, checks its parameters, calls the maker. An std::invalid_argument of
  /// the maker (a class that refuses its arguments) becomes a SceneError at the node.
  Product make(const SceneNode& node, const SceneDocument* document, Context&... context) const {
    const Row& row = row_of(node);
    const Properties properties(node, row.parameters, document);
    try {
      return row.make(properties, context...);
    } catch (const std::invalid_argument& error) {
      std::string reason = error.what();
      if (reason.starts_with(node.type + ": ")) reason = reason.substr(node.type.size() + 2);
      throw SceneError(node.where, node.describe() + ": " + reason);
    }
  }

 private:
  Category category_;
  std::vector<Row> rows_;
  std::vector<std::string> unsupported_;
  std::map<std::string, std::string> advice_;
};

}  // namespace turbid
