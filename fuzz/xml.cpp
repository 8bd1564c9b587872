// Scene files: the XML reader, and the loader on what it made. Nothing but the text is read: no file can be opened
// meanwhile.
#include <sys/resource.h>

#include <set>

#include "quiet.h"
#include "scene/loader.h"

namespace {

/// While it lives this process opens no files.
class NoFiles {
 public:
  NoFiles() {
    getrlimit(RLIMIT_NOFILE, &before_);
    const rlimit none{0, before_.rlim_max};
    setrlimit(RLIMIT_NOFILE, &none);
  }
  ~NoFiles() { setrlimit(RLIMIT_NOFILE, &before_); }
  NoFiles(const NoFiles&) = delete;
  NoFiles& operator=(const NoFiles&) = delete;

 private:
  rlimit before_;
};

/// Generators make as many triangles as they are asked for: no matter for a fuzzer with little memory.
bool generates_shapes(const turbid::SceneNode& node, std::set<const turbid::SceneNode*>& seen) {
  if (!seen.insert(&node).second) return false;
  if (node.category == turbid::Category::kShape && node.type == "generated") return true;
  for (const turbid::Child& child : node.children)
    if (generates_shapes(*child.node, seen)) return true;
  return false;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  using namespace turbid;
  const NoFiles guard;
  try {
    const std::string text(reinterpret_cast<const char*>(bytes), size);
    SceneDocument document = read_document_from_string(text, "fuzz.xml");
    std::set<const SceneNode*> seen;
    if (!generates_shapes(*document.root, seen)) load_scene(std::move(document));
  } catch (const SceneError&) {
  } catch (const FileError&) {
  }
  return 0;
}
