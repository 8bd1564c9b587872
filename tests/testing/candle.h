#pragma once
#include <filesystem>
#include <string>

namespace turbid::testing {

/// Where the candle of Křivánek et al. 2014 stands, as SmallUPBP ships it: candle.obj with all its groups. It need not
/// exist: tests that use it skip with candle_absent() as their message.
std::filesystem::path candle_folder();
std::string candle_absent();

/// Writes the candle into `folder` as a Mitsuba scene, one mesh per group, and returns the scene file. Parameters of
/// the scene: size (pixels), max_depth.
std::filesystem::path write_candle(const std::filesystem::path& folder);

}  // namespace turbid::testing
