#pragma once
#include "scene/document.h"
#include "scene/scene.h"

namespace turbid {

/// The image algorithm that a scene file asks for, not yet made: the integrator room owns its table. `node` may be
/// edited (a copy) before it is made, see `set_value`.
struct IntegratorDescription {
  std::shared_ptr<const SceneNode> node;
  /// False when the file names none: `node` then asks for a plain path tracer.
  bool declared = false;
};

/// A scene file turned into what Scene is assembled from.
struct LoadedScene {
  SceneParts parts;
  IntegratorDescription integrator;
  std::shared_ptr<const SceneDocument> document;
  /// Every file that was read (XML, meshes, images ...), without repetition: what a checkpoint must hash.
  std::vector<std::filesystem::path> files;
};

/// Reads a scene file and everything it refers to. Throws SceneError (exit code 3) or FileError (4).
LoadedScene load_scene(const std::filesystem::path& file, const Overrides& overrides = {});
/// The same from text: `name` stands for the file in messages, relative file names start from `folder`.
LoadedScene load_scene_from_string(const std::string& xml, const std::string& name, const Overrides& overrides = {},
                                   const std::filesystem::path& folder = {});

/// The same from a document that has been read, and perhaps edited, before.
LoadedScene load_scene(SceneDocument document);

/// The integrator of a document, or a `path` where it has none. Throws SceneError when there are several.
IntegratorDescription find_integrator(const SceneDocument& document);

/// Gives a node a value from the command line ("key=value"), replacing what the file says.
void set_value(SceneNode& node, const std::string& name, const std::string& text, const SourceLocation& where = {});

}  // namespace turbid
