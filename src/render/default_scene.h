#pragma once
#include <string_view>

namespace turbid {

/// The scene that `turbid render` shows without being given one; the build puts a file of scenes/ into the program.
std::string_view default_scene();

}  // namespace turbid
