#include "scene/xml_reader.h"

#include <algorithm>
#include <fstream>
#include <optional>
#include <sstream>

#include "scene/spectrum_reader.h"
#include "scene/suggestions.h"
#include "scene/transform_reader.h"
#include "scene/values.h"

namespace turbid {
namespace {

constexpr Category kCategories[] = {Category::kShape, Category::kBsdf,    Category::kEmitter, Category::kMedium,
                                    Category::kPhase, Category::kTexture, Category::kVolume,  Category::kSensor,
                                    Category::kFilm,  Category::kSampler, Category::kFilter,  Category::kIntegrator};
const std::vector<std::string> kValueTags = {"boolean", "integer", "float",    "string",   "point",
                                             "vector",  "rgb",     "spectrum", "transform"};
const std::vector<std::string> kStructureTags = {"ref", "include", "alias", "default", "path"};

std::optional<Category> category_of(const Element& element) {
  // <spectrum type="..."> is a texture, as in Mitsuba.
  if (element.tag() == "spectrum" && element.has("type")) return Category::kTexture;
  for (const Category category : kCategories)
    if (element.tag() == to_string(category)) return category;
  return std::nullopt;
}

std::vector<std::string> all_tags() {
  std::vector<std::string> tags = kValueTags;
  tags.insert(tags.end(), kStructureTags.begin(), kStructureTags.end());
  for (const Category category : kCategories) tags.push_back(to_string(category));
  return tags;
}

std::string read_whole(const std::filesystem::path& path) {
  std::error_code ignored;
  if (!file_exists(path)) throw FileError(path.string(), "the file does not exist");
  if (std::filesystem::is_directory(path, ignored))
    throw FileError(path.string(), "is a folder, expected a scene file");
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  if (!file) throw FileError(path.string(), "cannot be read");
  return text.str();
}

/// Is it a scene of Mitsuba 0.x? Throws SceneError for versions that are not understood.
bool is_legacy(const Element& root) {
  const std::string version = root.get("version");
  int major = 0, minor = 0;
  char dot = 0;
  std::istringstream stream(version);
  if (!(stream >> major))
    throw SceneError(root.where("version"), "'" + version + "' is not a version, expected for instance 3.0.0");
  if (major >= 2) return false;
  stream >> dot >> minor;
  constexpr int kOldestMinor = 4;  // before that, plugins had other names and sensors were mirrored
  if (major == 0 && minor < kOldestMinor)
    throw SceneError(root.where("version"), "this is a scene for Mitsuba " + version +
                                                "; only scenes of version 0.4.0 or later can be read (Mitsuba 0.6 "
                                                "saves older ones as 0.6.0)");
  return true;
}

std::string list_of(const std::vector<std::filesystem::path>& folders) {
  std::string list;
  for (const auto& folder : folders) list += (list.empty() ? "" : ", ") + (folder.empty() ? "." : folder.string());
  return list;
}

constexpr size_t kMostFiles = 10000;
constexpr int kDeepest = 200;  ///< of tags inside tags, includes counted

}  // namespace

SceneDocument XmlReader::read_file(const std::filesystem::path& path) { return finish(open(path)); }

SceneDocument XmlReader::read_text(const std::string& text, const std::string& name,
                                   const std::filesystem::path& folder) {
  return finish(parse(text, name, folder));
}

SceneDocument XmlReader::finish(File& file) {
  document_.search_folders.push_back(file.folder);
  const Element root = root_of(file, nullptr);
  if (root.tag() != "scene") root.refuse("the root is <" + root.tag() + ">, expected <scene>");
  root.check_attributes({"version"}, {"id"});
  auto scene = std::make_shared<SceneNode>();
  scene->type = "scene";
  scene->where = root.where();
  document_.root = scene;
  read_children(root, *scene, file);
  references_.link(scene);
  variables_.require_all_overrides_used(file.source.file());
  return std::move(document_);
}

XmlReader::File& XmlReader::open(const std::filesystem::path& path) {
  const std::string text = read_whole(path);
  document_.files.push_back(path);
  including_.push_back(std::filesystem::weakly_canonical(path));
  return parse(text, path.string(), path.parent_path());
}

XmlReader::File& XmlReader::parse(const std::string& text, const std::string& name,
                                  const std::filesystem::path& folder) {
  constexpr std::string_view kUtf8Mark = "\xef\xbb\xbf";
  const bool marked = text.starts_with(kUtf8Mark);
  File& file = files_.emplace_back(File{SourceText(name, marked ? text.substr(kUtf8Mark.size()) : text), folder, {}});
  const std::string& source = file.source.text();
  if (source.find('\0') != std::string::npos)
    throw SceneError({name, 1, 0}, "this is not text in UTF-8 (it has bytes that are zero)");
  const pugi::xml_parse_result result =
      file.xml.load_buffer(source.data(), source.size(), pugi::parse_default, pugi::encoding_utf8);
  if (!result) {
    std::string what = result.description();
    what[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(what[0])));
    if (result.status == pugi::status_end_element_mismatch) what = "this does not close the tag that is open here";
    if (source.find_first_not_of(" \t\r\n", static_cast<size_t>(result.offset) + 1) == std::string::npos)
      what = source.empty() ? "it is empty" : "the file ends before all tags are closed";
    throw SceneError(file.source.locate(static_cast<size_t>(result.offset)), "this is not well-formed XML: " + what);
  }
  return file;
}

Element XmlReader::root_of(File& file, const File* includer) {
  const pugi::xml_node node = file.xml.document_element();
  const Element root(node, file.source, variables_);
  for (pugi::xml_node next = node.next_sibling(); next; next = next.next_sibling())
    if (next.type() == pugi::node_element)
      root.element(next).refuse("a scene file has one root, found <" + std::string(next.name()) + "> after <" +
                                root.tag() + ">");
  if (!root.has("version") && !includer)
    root.refuse("<" + root.tag() + "> needs the attribute 'version', for instance version=\"3.0.0\"");
  file.legacy = root.has("version") ? is_legacy(root) : includer->legacy;
  if (file.legacy) upgrade_.upgrade_tags(node);
  return root;
}

void XmlReader::read_children(const Element& element, SceneNode& node, File& file) {
  if (++depth_ > kDeepest) element.refuse("tags are nested too deeply");
  for (const pugi::xml_node& child : element.node().children()) {
    if (child.type() == pugi::node_pcdata || child.type() == pugi::node_cdata)
      element.refuse("<" + element.tag() + "> cannot contain text: values are written in attributes");
    if (child.type() == pugi::node_element) read_child(element.element(child), node, file);
  }
  --depth_;
}

void XmlReader::read_child(const Element& element, SceneNode& node, File& file) {
  const std::string tag = element.tag();
  if (const auto category = category_of(element)) return read_object(element, *category, node, file);
  if (std::find(kValueTags.begin(), kValueTags.end(), tag) != kValueTags.end()) return read_value(element, node);
  if (tag != "include" && tag != "scene") element.check_empty();
  if (tag == "ref") return read_reference(element, node);
  if (tag == "include") return read_include(element, node, file);
  if (tag == "path") return read_path(element, node, file);
  if (tag == "default") {
    element.check_attributes({"name", "value"});
    if (element.get("name").empty()) element.refuse("<default> needs a name that is not empty");
    return variables_.set_default(element.get("name"), element.get("value"));
  }
  if (tag == "alias") {
    element.check_attributes({"id", "as"});
    return references_.alias(element.get("id"), element.get("as"), element.where());
  }
  if (is_transform_operation(tag)) element.refuse("<" + tag + "> can only stand inside <transform>");
  if (tag == "scene") element.refuse("<scene> can only be the root");
  element.refuse("unknown tag <" + tag + ">" + suggestion(tag, all_tags()));
}

void XmlReader::read_object(const Element& element, Category category, SceneNode& owner, File& file) {
  element.check_attributes({"type"}, {"id", "name", "version"});
  auto node = std::make_shared<SceneNode>();
  node->category = category;
  node->type = element.get("type");
  node->id = element.get("id");
  node->where = element.where();
  if (!node->id.empty()) references_.declare(node);
  read_children(element, *node, file);
  if (file.legacy) upgrade_.upgrade_node(*node);
  owner.children.push_back({element.get("name"), node, element.where()});
}

void XmlReader::read_reference(const Element& element, SceneNode& owner) {
  element.check_attributes({"id"}, {"name"});
  references_.refer(owner, owner.children.size(), element.get("id"));
  owner.children.push_back({element.get("name"), nullptr, element.where()});
}

void XmlReader::read_value(const Element& element, SceneNode& owner) {
  Value value = value_of(element, owner);
  const std::string name = element.get("name");
  for (const NamedValue& other : owner.values)
    if (other.name == name)
      element.refuse("'" + name + "' is given twice, first in line " + std::to_string(other.where.line));
  owner.values.push_back(
      {name, std::move(value), element.where(element.has("value") ? "value" : "name"), element.where("name")});
}

Value XmlReader::value_of(const Element& element, const SceneNode& owner) {
  const std::string tag = element.tag();
  if (tag == "transform") return transform_of(element);
  element.check_empty();
  if (tag == "spectrum") return spectrum_of(element, owner);
  if (tag == "point" || tag == "vector") {
    if (!element.has("value")) {
      element.check_attributes({"name", "x", "y", "z"});
      return Imath::V3d(read_number(element.get("x"), element.where("x")),
                        read_number(element.get("y"), element.where("y")),
                        read_number(element.get("z"), element.where("z")));
    }
    if (element.has("x") || element.has("y") || element.has("z"))
      element.refuse("<" + tag + "> takes either 'value' or 'x', 'y', 'z'");
  }
  element.check_attributes({"name", "value"});
  const std::string text = element.get("value");
  const SourceLocation where = element.where("value");
  if (tag == "boolean") return read_boolean(text, where);
  if (tag == "integer") return read_integer(text, where);
  if (tag == "float") return read_number(text, where);
  if (tag == "string") return text;
  if (tag == "rgb") return read_rgb(text, where);
  return read_vector(text, where);
}

Spectrum XmlReader::spectrum_of(const Element& element, const SceneNode& owner) {
  element.check_attributes({"name"}, {"value", "filename"});
  if (element.has("value") == element.has("filename")) element.refuse("<spectrum> needs either 'value' or 'filename'");
  const SpectralUse use = spectral_use(owner.category, element.get("name"));
  if (element.has("value")) return read_spectrum(element.get("value"), use, element.where("value"));
  const std::filesystem::path path = find_file(element.get("filename"), {});
  if (!file_exists(path))
    throw SceneError(element.where("filename"), "there is no file '" + element.get("filename") +
                                                    "' (looked in: " + list_of(document_.search_folders) + ")");
  document_.files.push_back(path);
  return curve_to_rgb(read_spectrum_file(path), use);
}

Transform XmlReader::transform_of(const Element& element) {
  element.check_attributes({"name"});
  Transform transform;
  for (const pugi::xml_node& child : element.node().children()) {
    if (child.type() == pugi::node_pcdata || child.type() == pugi::node_cdata)
      element.refuse("<transform> cannot contain text");
    if (child.type() != pugi::node_element) continue;
    transform = read_transform_operation(element.element(child)) * transform;
  }
  return transform;
}

void XmlReader::read_include(const Element& element, SceneNode& owner, File& file) {
  element.check_attributes({"filename"});
  element.check_empty();
  const std::string name = element.get("filename");
  const std::filesystem::path path = find_file(name, file.folder);
  if (!file_exists(path)) {
    auto folders = document_.search_folders;
    if (std::find(folders.begin(), folders.end(), file.folder) == folders.end()) folders.push_back(file.folder);
    throw SceneError(element.where("filename"),
                     "there is no file '" + name + "' (looked in: " + list_of(folders) + ")");
  }
  if (document_.files.size() > kMostFiles) element.refuse("the scene includes too many files");
  if (std::find(including_.begin(), including_.end(), std::filesystem::weakly_canonical(path)) != including_.end())
    throw SceneError(element.where("filename"), "cyclic include: '" + name + "' is already being read");
  File& included = open(path);
  const Element root = root_of(included, &file);
  if (root.tag() == "scene") {
    read_children(root, owner, included);
  } else {
    read_child(root, owner, included);
  }
  including_.pop_back();
}

void XmlReader::read_path(const Element& element, const SceneNode& owner, const File& file) {
  element.check_attributes({"value"});
  if (owner.category != Category::kScene) element.refuse("<path> can only stand directly inside <scene>");
  const std::string name = element.get("value");
  std::filesystem::path folder = file.folder / name;
  if (!file_exists(folder)) folder = document_.resolve(name);
  if (!file_exists(folder)) throw SceneError(element.where("value"), "there is no folder '" + name + "'");
  document_.search_folders.insert(document_.search_folders.begin(), folder.lexically_normal());
}

std::filesystem::path XmlReader::find_file(const std::string& name, const std::filesystem::path& folder) const {
  const std::filesystem::path path = document_.resolve(name);
  if (!file_exists(path) && file_exists(folder / name)) return folder / name;
  return path;
}

SceneDocument read_document(const std::filesystem::path& file, const Overrides& overrides) {
  return XmlReader(overrides).read_file(file);
}

SceneDocument read_document_from_string(const std::string& xml, const std::string& name, const Overrides& overrides,
                                        const std::filesystem::path& folder) {
  return XmlReader(overrides).read_text(xml, name, folder);
}

}  // namespace turbid
