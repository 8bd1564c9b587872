#include "scene/loader.h"

#include <algorithm>
#include <set>

#include "scene/attribute_check.h"
#include "scene/scene_loader.h"
#include "sensor/perspective.h"
#include "surface/diffuse.h"
#include "texture/constant.h"

namespace turbid {

SceneLoader::SceneLoader(std::shared_ptr<const SceneDocument> document)
    : document_(std::move(document)), builder_(*document_, find_scene_unit(*find_integrator(*document_).node)) {}

std::vector<const SceneNode*> SceneLoader::nodes(Category category) const {
  std::vector<const SceneNode*> result;
  for (const Child& child : document_->root->children)
    if (child.node->category == category && std::find(result.begin(), result.end(), child.node.get()) == result.end())
      result.push_back(child.node.get());
  return result;
}

LoadedScene SceneLoader::load() {
  // The scene itself has no parameters: anything but plugins is a slip.
  SceneNode scene = *document_->root;
  scene.children.clear();
  const std::vector<Parameter> no_parameters;
  const Properties nothing(scene, no_parameters);

  check_the_rest();
  load_world();
  load_shapes();
  load_emitters();
  load_sensor();
  return {std::move(parts_), find_integrator(*document_), document_, all_files()};
}

/// Materials, media and textures at the top that nobody may refer to: their errors count too.
void SceneLoader::check_the_rest() {
  for (const SceneNode* node : nodes(Category::kTexture)) builder_.texture(*node);
  for (const SceneNode* node : nodes(Category::kVolume)) builder_.volume(*node);
  for (const SceneNode* node : nodes(Category::kPhase)) builder_.phase(*node);
  for (const SceneNode* node : nodes(Category::kMedium)) builder_.medium(*node);
  for (const SceneNode* node : nodes(Category::kBsdf)) builder_.bsdf(*node);
  for (const SceneNode* node : nodes(Category::kFilm)) film_table().make(*node, document_.get(), builder_);
  for (const SceneNode* node : nodes(Category::kSampler)) sampler_table().make(*node, document_.get(), builder_);
  for (const SceneNode* node : nodes(Category::kFilter)) filter_table().make(*node, document_.get(), builder_);
}

/// The `priority` of a shape, else of its interior medium.
void SceneLoader::read_priority(const Properties& shape, Object& object) const {
  const auto take = [&](const Properties& p) {
    object.priority = static_cast<int>(p.integer("priority"));
    object.priority_declared = true;
  };
  if (shape.has("priority")) return take(shape);
  const SceneNode* medium = shape.child("interior");
  if (!medium) return;
  const Properties p(*medium, medium_table().row_of(*medium).parameters, document_.get());
  if (p.has("priority")) take(p);
}

/// A medium directly in the scene with the name "world".
void SceneLoader::load_world() {
  for (const Child& child : document_->root->children) {
    if (child.node->category != Category::kMedium || child.name != "world") continue;
    if (parts_.world_medium) throw SceneError(child.where, "a scene can have one medium named 'world'");
    parts_.world_medium = builder_.medium(*child.node);
  }
}

Object SceneLoader::assemble(const SceneNode& node, std::shared_ptr<const Shape> shape) {
  const Properties p(node, shape_table().row_of(node).parameters, document_.get());
  Object object;
  object.id = node.id;
  object.bsdf = builder_.bsdf(p, "bsdf");
  check_mesh_attributes(node, *shape);
  object.interior = builder_.medium(p, "interior");
  object.exterior = builder_.medium(p, "exterior");
  object.bounds_media = object.interior || object.exterior;
  read_priority(p, object);
  if (const SceneNode* emitter = p.child("emitter")) {
    if (!(shape->area() > 0)) p.refuse("emitter", "cannot be given: this shape cannot shine");
    const auto made = emitter_table().make(*emitter, document_.get(), builder_, EmitterPlace{shape});
    object.emitter = std::dynamic_pointer_cast<SurfaceEmitter>(made);
  }
  if (!object.bsdf) {
    const float reflectance = object.emitter ? 0.0f : 0.5f;  // Mitsuba's defaults
    object.bsdf = std::make_shared<Diffuse>(std::make_shared<ConstantTexture>(reflectance));
    if (object.bounds_media)
      log_notice(
          node.describe() + (node.id.empty() ? "" : " '" + node.id + "'") +
          " bounds a medium and has no bsdf: it is diffuse, as in Mitsuba; for an invisible boundary use 'null'");
  }
  object.shape = std::move(shape);
  return object;
}

void SceneLoader::load_emitters() {
  const SceneNode* environment = nullptr;
  for (const SceneNode* node : nodes(Category::kEmitter)) {
    const auto emitter = emitter_table().make(*node, document_.get(), builder_, EmitterPlace{});
    if (emitter->is_environment() && environment)
      throw SceneError(node->where, "a scene can have one environment, found " + node->describe() + " after " +
                                        environment->describe() + " in line " +
                                        std::to_string(environment->where.line));
    if (emitter->is_environment()) environment = node;
    parts_.emitters.push_back(emitter);
  }
}

namespace {

/// Mitsuba's camera for scenes without one: looks along +z and sees everything.
std::shared_ptr<const Sensor> default_sensor(const SceneParts& parts) {
  Bounds3 bounds;
  for (const Object& object : parts.objects) bounds.extendBy(object.shape->bounds());
  if (bounds.isEmpty()) bounds = Bounds3(Vec3(-1), Vec3(1));
  constexpr double kFov = 45;
  const double aspect = static_cast<double>(parts.film.size.x) / static_cast<double>(parts.film.size.y);
  const double extent = static_cast<double>(max_component(bounds.size()));
  const double distance = extent / (2 * std::tan(kFov / 2 * std::numbers::pi / 180));
  const Vec3 center = bounds.center();
  const auto to_world = Transform::translate(static_cast<double>(center.x), static_cast<double>(center.y),
                                             static_cast<double>(bounds.min.z) - distance);
  const ClipRange clip{static_cast<float>(distance / 100), static_cast<float>(5 * extent + distance)};
  return std::make_shared<PerspectiveSensor>(to_world, kFov, aspect, clip);
}

}  // namespace

void SceneLoader::load_sensor() {
  const std::vector<const SceneNode*> all = nodes(Category::kSensor);
  if (all.empty()) {
    log_notice("the scene has no sensor: a perspective one looks along +z at everything");
    parts_.film.filter = ReconstructionFilter(ReconstructionFilter::Kind::kGaussian, 0.5f);
    parts_.sample_count = SamplerSettings{}.sample_count;
    parts_.sensor = default_sensor(parts_);
    return;
  }
  if (all.size() > 1) log_notice("the scene has several sensors: the first one is used");
  const SceneNode& node = *all.front();
  const Properties p(node, sensor_table().row_of(node).parameters, document_.get());
  if (const SceneNode* film = p.child("film"))
    parts_.film = film_table().make(*film, document_.get(), builder_);
  else
    parts_.film.filter = ReconstructionFilter(ReconstructionFilter::Kind::kGaussian, 0.5f);
  SamplerSettings sampler;
  if (const SceneNode* child = p.child("sampler")) sampler = sampler_table().make(*child, document_.get(), builder_);
  parts_.sampler = sampler.kind;
  parts_.sample_count = sampler.sample_count;
  parts_.sensor_medium = builder_.medium(p, "medium");
  parts_.sensor_medium_declared = parts_.sensor_medium != nullptr;
  parts_.sensor = sensor_table().make(node, document_.get(), builder_, parts_.film);
}

std::vector<std::filesystem::path> SceneLoader::all_files() const {
  std::vector<std::filesystem::path> files = document_->files;
  // Shapes are read in any order: theirs are sorted.
  std::vector<std::filesystem::path> read = builder_.files();
  std::sort(read.begin(), read.end());
  files.insert(files.end(), read.begin(), read.end());
  std::set<std::filesystem::path> seen;
  std::erase_if(files, [&](const std::filesystem::path& file) { return !seen.insert(file).second; });
  return files;
}

LoadedScene load_scene(SceneDocument document) {
  return SceneLoader(std::make_shared<const SceneDocument>(std::move(document))).load();
}

LoadedScene load_scene(const std::filesystem::path& file, const Overrides& overrides) {
  return load_scene(read_document(file, overrides));
}

LoadedScene load_scene_from_string(const std::string& xml, const std::string& name, const Overrides& overrides,
                                   const std::filesystem::path& folder) {
  return load_scene(read_document_from_string(xml, name, overrides, folder));
}

}  // namespace turbid
