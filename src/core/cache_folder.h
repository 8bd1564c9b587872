#pragma once
#include <string>

namespace turbid {

/// The value of an environment variable, or an empty text.
std::string environment_variable(const char* name);

/// Where the user keeps what can be made again: $XDG_CACHE_HOME/turbid/NAME, else ~/.cache/turbid/NAME. The environment
/// variable `override_name`, where it is set, names the folder itself.
std::string cache_folder(const std::string& name, const char* override_name);

/// Makes a folder and those above it, unless they are there. Throws FileError.
void make_folder(const std::string& path);

}  // namespace turbid
