#pragma once
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "core/error.h"
#include "core/spectrum.h"
#include "core/transform.h"

namespace turbid {

/// What a node of a scene file stands for: its XML tag.
enum class Category {
  kScene,
  kShape,
  kBsdf,
  kEmitter,
  kMedium,
  kPhase,
  kTexture,  ///< also <spectrum type="...">
  kVolume,
  kSensor,
  kFilm,
  kSampler,
  kFilter,  ///< <rfilter>
  kIntegrator,
};
/// The tag, as written in files: "bsdf", "rfilter" ...
const char* to_string(Category category);

/// A value that has no type yet: it comes from the command line or from the default of a table, and is read as whatever
/// type the plugin declares.
struct UntypedText {
  std::string text;
  bool operator==(const UntypedText&) const = default;
};

/// A value in a scene file, typed by its tag: <boolean>, <integer>, <float>, <string>, <point> or <vector>, <rgb> or
/// <spectrum> (already converted to linear RGB), <transform>.
using Value = std::variant<UntypedText, bool, int64_t, double, std::string, Imath::V3d, Spectrum, Transform>;
/// The tag that makes such a value, with its article, for messages: "a float", "an integer" ...
std::string describe_type(const Value& value);

/// A named value of a node and where it stands.
struct NamedValue {
  std::string name;
  Value value;
  SourceLocation where;         ///< of the value
  SourceLocation name_where{};  ///< of the name
};

struct SceneNode;

/// A plugin inside a plugin, written in place or by <ref>. Nodes that are referred to several times are shared: the
/// same pointer means the same object.
struct Child {
  std::string name;  ///< empty when the file gives none
  std::shared_ptr<const SceneNode> node;
  SourceLocation where;  ///< of the <ref>, or of the node itself
};

/// One plugin as the file describes it: nothing is interpreted yet. References form a tree that may share branches and
/// has no cycle.
struct SceneNode {
  Category category = Category::kScene;
  std::string type;  ///< which plugin
  std::string id;    ///< empty when the file gives none
  std::vector<NamedValue> values;
  std::vector<Child> children;
  SourceLocation where;

  /// "bsdf 'diffuse'", for messages.
  std::string describe() const {
    return category == Category::kScene ? "the scene" : std::string(to_string(category)) + " '" + type + "'";
  }
};

/// Do the two describe one thing, wherever they stand and whatever id they have? Order counts.
bool describe_the_same(const SceneNode& a, const SceneNode& b);

/// Values of $variables given on the command line (-D name=value); they win over <default>.
using Overrides = std::map<std::string, std::string>;

/// A scene file with everything that it includes, read but not interpreted.
struct SceneDocument {
  std::shared_ptr<const SceneNode> root;              ///< category kScene
  std::vector<std::filesystem::path> search_folders;  ///< where relative file names are looked up, first one first
  std::vector<std::filesystem::path> files;           ///< all XML and spectrum files that were read, in order

  /// The file that a name in the scene means: an absolute name, or found in the search folders. Returns the name itself
  /// when there is no such file.
  std::filesystem::path resolve(const std::string& name) const;
};

/// True when there is something of that name; never throws (names may be nonsense).
bool file_exists(const std::filesystem::path& path);

/// Reads a Mitsuba scene file (version 0.4.0 or later; see LegacyUpgrade for those before 2.0.0). Throws SceneError
/// when its text is wrong, FileError when a file cannot be read.
SceneDocument read_document(const std::filesystem::path& file, const Overrides& overrides = {});
/// The same from text; `name` stands for the file in messages, relative file names start from `folder`.
SceneDocument read_document_from_string(const std::string& xml, const std::string& name,
                                        const Overrides& overrides = {}, const std::filesystem::path& folder = {});

}  // namespace turbid
