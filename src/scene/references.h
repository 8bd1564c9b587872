#pragma once
#include <unordered_map>

#include "scene/document.h"

namespace turbid {

/// The names (id="...") of a scene file and who refers to them. References may stand before what they refer to, so they
/// are resolved when everything has been read.
class References {
 public:
  /// A node with an id. Throws SceneError when the id is taken.
  void declare(const std::shared_ptr<const SceneNode>& node);
  /// <alias id="id" as="as">: another name.
  void alias(const std::string& id, const std::string& as, const SourceLocation& where);
  /// owner.children[child] is a <ref> to `id`, to be filled in.
  void refer(SceneNode& owner, size_t child, const std::string& id);

  /// Fills in all references below `root`. Throws SceneError for unknown ids and for cycles.
  void link(const std::shared_ptr<const SceneNode>& root);

 private:
  struct Pending {
    SceneNode* owner;
    size_t child;
    std::string id;
  };
  struct Alias {
    std::string id;
    SourceLocation where;
  };
  enum class State { kOpen, kDone };

  void check_free(const std::string& id, const SourceLocation& where) const;
  std::shared_ptr<const SceneNode> find(const std::string& id, const SourceLocation& where) const;
  void visit(const SceneNode& node);
  /// The chain of references has come back to `node`, which is still being visited.
  [[noreturn]] void refuse_cycle(const SceneNode& node) const;

  std::map<std::string, std::shared_ptr<const SceneNode>> nodes_;
  std::map<std::string, Alias> aliases_;
  std::unordered_map<const SceneNode*, std::vector<Pending>> pending_;
  std::unordered_map<const SceneNode*, State> states_;
  std::vector<const Pending*> chain_;  ///< the references that are being followed
};

}  // namespace turbid
