#include "experiment/program_figure.h"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>

#include "core/cache_folder.h"
#include "core/error.h"
#include "core/hash.h"
#include "experiment/markdown_tables.h"
#include "experiment/reference.h"
#include "image/atomic_file.h"

namespace turbid {
namespace {

namespace fs = std::filesystem;

std::string program_path(const std::string& name) {
  fs::path folder = environment_variable("TURBID_PROGRAMS");
  if (folder.empty()) folder = fs::read_symlink("/proc/self/exe").parent_path() / "experiments";
  const fs::path path = folder / name;
  if (!fs::exists(path))
    throw UsageError(fmt::format("{} is not built: ./turbid build {} (or TURBID_PROGRAMS names the folder that has it)",
                                 path.string(), name));
  return path.string();
}

/// Runs it with its standard output in a pipe; `status` as of waitpid.
std::string output_of(const std::string& path, const std::vector<std::string>& arguments, const std::string& folder,
                      int& status) {
  int ends[2];
  if (::pipe(ends) != 0) throw Error("no pipe: " + std::string(std::strerror(errno)), 1);
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  ::posix_spawn_file_actions_addclose(&actions, ends[0]);
  ::posix_spawn_file_actions_addclose(&actions, ends[1]);
  ::posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  std::vector<std::string> words = {path};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  pid_t child = 0;
  const int failure = ::posix_spawn(&child, path.c_str(), &actions, nullptr, pointers.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  ::close(ends[1]);
  std::string text;
  if (failure == 0) {
    std::array<char, 4096> buffer;
    for (;;) {
      const ssize_t count = ::read(ends[0], buffer.data(), buffer.size());
      if (count > 0) text.append(buffer.data(), static_cast<size_t>(count));
      if (count == 0 || (count < 0 && errno != EINTR)) break;
    }
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
  }
  ::close(ends[0]);
  if (failure != 0) throw Error(path + " cannot be started: " + std::strerror(failure), 1);
  return text;
}

const std::vector<std::string>& arguments_of(const ProgramSettings& program, double time_scale) {
  return time_scale < 1 && !program.shorter.empty() ? program.shorter : program.arguments;
}

}  // namespace

std::string program_line(const Experiment& experiment, double time_scale) {
  return fmt::format("{} {}", experiment.program->name, fmt::join(arguments_of(*experiment.program, time_scale), " "));
}

uint64_t program_fingerprint(const Experiment& experiment, double time_scale) {
  return hash_bytes(read_file(program_path(experiment.program->name)),
                    hash_bytes(program_line(experiment, time_scale)));
}

std::string run_program_figure(const Experiment& experiment, double time_scale) {
  const ProgramSettings& program = *experiment.program;
  const fs::path folder = fs::absolute(experiment.file).parent_path().parent_path();
  int status = 0;
  std::string text = output_of(program_path(program.name), arguments_of(program, time_scale), folder.string(), status);
  if (WIFSIGNALED(status) && (WTERMSIG(status) == SIGINT || WTERMSIG(status) == SIGTERM)) throw Interrupted();
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) throw Error(program.name + " failed", 1);
  return text;
}

Report report_of(const Experiment& experiment, const std::string& printed,
                 const std::map<std::string, std::string>& about) {
  Report report{.title = experiment.title};
  report.subtitle = experiment.figure + (experiment.figure.empty() ? "" : ". ") + experiment.about;
  report.tables = markdown_tables(printed);
  for (const auto& [name, value] : about) report.facts.emplace_back(name, value);
  return report;
}

}  // namespace turbid
