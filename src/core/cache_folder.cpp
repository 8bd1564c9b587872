#include "core/cache_folder.h"

#include <cstdlib>
#include <filesystem>

#include "core/error.h"

namespace turbid {

std::string environment_variable(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

std::string cache_folder(const std::string& name, const char* override_name) {
  if (const std::string folder = environment_variable(override_name); !folder.empty()) return folder;
  if (const std::string cache = environment_variable("XDG_CACHE_HOME"); !cache.empty())
    return cache + "/turbid/" + name;
  const std::string home = environment_variable("HOME");
  return (home.empty() ? "." : home) + "/.cache/turbid/" + name;
}

void make_folder(const std::string& path) {
  std::error_code problem;
  std::filesystem::create_directories(path, problem);
  if (problem) throw FileError(path, "cannot be made: " + problem.message());
}

}  // namespace turbid
