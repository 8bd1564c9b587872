// Scene files: the XML reader, and the loader on what it made. Nothing but the text is read: texts that name files are
// left out.
#include <set>

#include "quiet.h"
#include "scene/loader.h"

namespace {

/// Generators make as many triangles as they are asked for: no matter for a fuzzer with little memory. And no files.
bool asks_for_too_much(const turbid::SceneNode& node, std::set<const turbid::SceneNode*>& seen) {
  if (!seen.insert(&node).second) return false;
  if (node.category == turbid::Category::kShape && node.type == "generated") return true;
  for (const turbid::NamedValue& value : node.values)
    if (value.name == "filename") return true;
  for (const turbid::Child& child : node.children)
    if (asks_for_too_much(*child.node, seen)) return true;
  return false;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  using namespace turbid;
  try {
    const std::string text(reinterpret_cast<const char*>(bytes), size);
    for (const char* word : {"<include", "<path", "filename"})
      if (text.find(word) != std::string::npos) return 0;
    SceneDocument document = read_document_from_string(text, "fuzz.xml");
    std::set<const SceneNode*> seen;
    if (!asks_for_too_much(*document.root, seen)) load_scene(std::move(document));
  } catch (const SceneError&) {
  } catch (const FileError&) {
  }
  return 0;
}
