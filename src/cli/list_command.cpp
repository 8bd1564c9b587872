#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "cli/command.h"
#include "core/error.h"
#include "integrator/integrators.h"
#include "medium/materials.h"
#include "scene/catalog.h"
#include "scene/suggestions.h"

namespace turbid {
namespace {

constexpr const char* kMaterials = "materials";

std::vector<CategoryDescription> all_categories() {
  std::vector<CategoryDescription> categories = plugin_catalog();
  categories.insert(categories.begin(), describe_table(integrator_table(), "integrators"));
  return categories;
}

template <class Names>
size_t widest(const Names& names) {
  size_t width = 0;
  for (const auto& name : names) width = std::max(width, name.size());
  return width;
}

void print_categories(const std::vector<CategoryDescription>& categories) {
  for (const CategoryDescription& category : categories) {
    std::vector<std::string> names;
    for (const PluginDescription& plugin : category.plugins) names.push_back(plugin.name);
    fmt::print("{:<12} {}\n", category.title, fmt::join(names, ", "));
  }
  fmt::print("{:<12} {} measured media\n", kMaterials, materials().size());
}

void print_category(const CategoryDescription& category) {
  std::vector<std::string> names;
  for (const PluginDescription& plugin : category.plugins) names.push_back(plugin.name);
  const size_t width = widest(names);
  for (const PluginDescription& plugin : category.plugins)
    fmt::print("{:<{}}  {}\n", plugin.name, width, plugin.summary);
}

std::string describe_default(const Parameter& parameter) {
  if (parameter.default_text == kRequired) return "required";
  return parameter.default_text.empty() ? "optional" : "default " + parameter.default_text;
}

void print_plugin(const CategoryDescription& category, const PluginDescription& plugin) {
  fmt::print("{} '{}': {}\n", to_string(category.category), plugin.name, plugin.summary);
  if (!plugin.aliases.empty()) fmt::print("also named {}\n", fmt::join(plugin.aliases, ", "));
  std::vector<std::string> names;
  for (const Parameter& parameter : plugin.parameters) names.push_back(parameter.name);
  const size_t width = widest(names);
  for (const Parameter& p : plugin.parameters) {
    std::string type = to_string(p.type);
    if (!p.choices.empty()) type = fmt::format("{}", fmt::join(p.choices, "|"));
    fmt::print("  {:<{}}  {}, {}\n  {:<{}}  {}", p.name, width, type, describe_default(p), "", width, p.meaning);
    if (const std::string range = p.range.describe(); range != kAnyNumber.describe()) fmt::print(" ({})", range);
    fmt::print("\n");
  }
}

void print_material(const Material& m) {
  const auto rgb = [](const Spectrum& s) { return fmt::format("{:g}, {:g}, {:g}", s[0], s[1], s[2]); };
  fmt::print("material '{}' ({})\n  {:<10} {} per mm{}\n  {:<10} {} per mm\n  {:<10} {}\n", m.name, m.source, "sigma_s",
             rgb(m.sigma_s), m.reduced ? ", reduced: sigma_s (1 - g)" : "", "sigma_a", rgb(m.sigma_a), "g", rgb(m.g));
  if (m.eta) fmt::print("  {:<10} {:g}\n", "eta", *m.eta);
}

void print_materials() {
  std::vector<std::string_view> names;
  for (const Material& m : materials()) names.push_back(m.name);
  const size_t width = widest(names);
  for (const Material& m : materials())
    fmt::print("{:<{}}  {}{}\n", m.name, width, m.source, m.reduced ? ", reduced" : "");
}

[[noreturn]] void fail_unknown(const std::string& what, const std::string& word,
                               const std::vector<std::string>& names) {
  throw UsageError("unknown " + what + " '" + word + "'" + suggestion(word, names));
}

bool has_name(const PluginDescription& plugin, const std::string& name) {
  return plugin.name == name || std::ranges::find(plugin.aliases, name) != plugin.aliases.end();
}

int run_list(const std::string& title, const std::string& name) {
  const std::vector<CategoryDescription> categories = all_categories();
  if (title.empty()) return print_categories(categories), kExitDone;
  if (title == kMaterials) {
    if (name.empty()) return print_materials(), kExitDone;
    if (const Material* material = find_material(name)) return print_material(*material), kExitDone;
    std::vector<std::string> names;
    for (const Material& m : materials()) names.emplace_back(m.name);
    fail_unknown("material", name, names);
  }
  std::vector<std::string> titles{kMaterials};
  for (const CategoryDescription& category : categories) {
    titles.push_back(category.title);
    if (category.title != title) continue;
    if (name.empty()) return print_category(category), kExitDone;
    std::vector<std::string> names;
    for (const PluginDescription& plugin : category.plugins) {
      if (has_name(plugin, name)) return print_plugin(category, plugin), kExitDone;
      names.push_back(plugin.name);
      names.insert(names.end(), plugin.aliases.begin(), plugin.aliases.end());
    }
    fail_unknown(to_string(category.category), name, names);
  }
  fail_unknown("category", title, titles);
}

}  // namespace

Command add_list_command(CLI::App& app) {
  struct Words {
    std::string category, name;
  };
  auto words = std::make_shared<Words>();
  CLI::App* command = app.add_subcommand("list", "list what scene files can ask for");
  command->add_option("CATEGORY", words->category,
                      "integrators, bsdfs, media, phases, materials, emitters, shapes ...");
  command->add_option("NAME", words->name, "one of them, with its parameters");
  return [words](const CommandLine&) { return run_list(words->category, words->name); };
}

}  // namespace turbid
