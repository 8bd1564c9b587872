#include "core/cache_folder.h"

#include <cstdlib>

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

}  // namespace turbid
