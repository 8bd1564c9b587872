#pragma once
#include <functional>
#include <string>

namespace CLI {
class App;
}

namespace turbid {

/// What main was called with, quoted for a shell: goes into the metadata of images.
using CommandLine = std::string;

/// A subcommand adds itself to the app: name, options, help. What it returns runs it after the words have been read and
/// returns the exit code.
using Command = std::function<int(const CommandLine&)>;
Command add_render_command(CLI::App& app);
Command add_compare_command(CLI::App& app);
Command add_info_command(CLI::App& app);
Command add_layers_command(CLI::App& app);
Command add_list_command(CLI::App& app);
Command add_table_command(CLI::App& app);
Command add_experiment_command(CLI::App& app);

inline constexpr int kExitDone = 0, kExitBroken = 1, kExitUsage = 2, kExitInterrupted = 130;

}  // namespace turbid
