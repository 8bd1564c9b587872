#pragma once
#include <optional>
#include <string>
#include <vector>

#include "scene/loader.h"

namespace turbid {

/// Which scene a command line means, and what it changes in it.
struct SceneChoice {
  std::string file;                      ///< empty: the embedded default scene
  std::vector<std::string> definitions;  ///< "name=value" of -D
  std::string integrator;                ///< "TYPE[,key=value]..." or empty
  std::string size;                      ///< "WxH" or empty

  /// The scene's name for messages and metadata.
  std::string name() const { return file.empty() ? "default scene" : file; }
};

/// The scene's document with its changes, and an integrator that can be made; nothing that it refers to is read yet.
/// Throws UsageError for words that make no sense, SceneError, FileError.
SceneDocument read_chosen(const SceneChoice& choice);

/// Reads the scene with its changes. Throws UsageError for words that make no sense, SceneError, FileError.
LoadedScene open_scene(const SceneChoice& choice);

/// A hash of all that the image depends on beside the size of a pass: the contents of the scene's files (all that it
/// was read from), what the command line changes in it, the seed, the version of the program.
uint64_t scene_fingerprint(const SceneChoice& choice, const std::vector<std::filesystem::path>& files, uint64_t seed);

/// "volpath max_depth=16", wrappers outside: "moment(volpath max_depth=16)".
std::string describe_integrator(const SceneNode& node);

}  // namespace turbid
