#include "cli/program.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <new>
#include <vector>

#include "cli/command.h"
#include "core/error.h"
#include "core/version.h"
#include "scene/suggestions.h"

namespace turbid {
namespace {

/// A word as a shell would need it.
std::string quoted(const std::string& word) {
  const std::string plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_=+.,:/@%";
  if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
  std::string result = "'";
  for (const char c : word) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

CommandLine command_line(int argc, const char* const* argv) {
  CommandLine line = "turbid";
  for (int i = 1; i < argc; ++i) line += " " + quoted(argv[i]);
  return line;
}

std::string version_text() {
  std::string text = "turbid " + std::string(version());
  if (!version_commit().empty()) text += " (" + std::string(version_commit()) + ")";
  return text;
}

int fail(const std::string& message, int code) {
  fmt::print(stderr, "turbid: {}\n", message);
  return code;
}

/// What went wrong with the words, and the nearest right one.
std::string usage_message(const CLI::App& app, const CLI::ParseError& error, const std::vector<std::string>& words) {
  std::string message = error.what();
  std::vector<std::string> commands;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    commands.push_back(command->get_name());
  const CLI::App* chosen = app.get_subcommands().empty() ? nullptr : app.get_subcommands().front();
  if (!chosen && !words.empty() && !words.front().starts_with("-")) {
    message = "unknown command '" + words.front() + "'" + suggestion(words.front(), commands);
  } else if (chosen) {
    std::vector<std::string> options;
    for (const CLI::Option* option : chosen->get_options())
      for (const std::string& name : option->get_lnames()) options.push_back("--" + name);
    for (const std::string& word : words) {
      const std::string name = word.substr(0, word.find('='));
      if (!word.starts_with("--") || std::find(options.begin(), options.end(), name) != options.end()) continue;
      message = "unknown option '" + name + "'" + suggestion(name, options);
      break;
    }
  }
  const std::string help = chosen ? "turbid " + chosen->get_name() + " --help" : "turbid --help";
  return message + "\n'" + help + "' lists what can be said";
}

int run(int argc, const char* const* argv) {
  CLI::App app("turbid: a physically based renderer for participating media");
  app.set_version_flag("--version", version_text());
  app.require_subcommand(1);
  app.get_formatter()->column_width(34);
  const std::vector<std::pair<std::string, Command>> commands = {{"render", add_render_command(app)},
                                                                 {"compare", add_compare_command(app)},
                                                                 {"layers", add_layers_command(app)},
                                                                 {"info", add_info_command(app)},
                                                                 {"list", add_list_command(app)},
                                                                 {"table", add_table_command(app)},
                                                                 {"experiment", add_experiment_command(app)}};
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& error) {
    if (argc <= 1) {
      fmt::print(stderr, "{}", app.help());
      return kExitUsage;
    }
    return fail(usage_message(app, error, {argv + 1, argv + argc}), kExitUsage);
  }
  for (const auto& [name, command] : commands)
    if (app.got_subcommand(name)) return command(command_line(argc, argv));
  return kExitUsage;
}

}  // namespace

int run_program(int argc, const char* const* argv) {
  try {
    return run(argc, argv);
  } catch (const Error& error) {
    return fail(error.what(), error.exit_code());
  } catch (const std::bad_alloc&) {
    return fail("there is not enough memory", kExitBroken);
  } catch (const std::exception& error) {
    return fail(std::string("unexpected error: ") + error.what(), kExitBroken);
  } catch (...) {
    return fail("unexpected error", kExitBroken);
  }
}

}  // namespace turbid
