#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <map>
#include <memory>
#include <set>

#include "cli/command.h"
#include "integrator/advice.h"
#include "integrator/table_advice.h"
#include "render/render_job.h"
#include "render/scene_choice.h"
#include "render/statistics.h"
#include "scene/scene_check.h"

namespace turbid {
namespace {

constexpr const char* kLine = "{:<12} {}\n";

std::string rgb(const Spectrum& s) {
  return s[0] == s[1] && s[1] == s[2] ? fmt::format("{:.4g}", s[0])
                                      : fmt::format("({:.4g}, {:.4g}, {:.4g})", s[0], s[1], s[2]);
}
std::string point(const Vec3& v) { return fmt::format("({:.4g}, {:.4g}, {:.4g})", v.x, v.y, v.z); }

std::string memory(double bytes) {
  return bytes < 1e9 ? fmt::format("{:.0f} MB", std::ceil(bytes / 1e6)) : fmt::format("{:.1f} GB", bytes / 1e9);
}

/// How often each type of a category stands in the scene, in shapes too.
std::map<std::string, size_t> count_types(const SceneNode& node, Category category) {
  std::map<std::string, size_t> counts;
  std::set<const SceneNode*> seen;
  const auto visit = [&](const auto& self, const SceneNode& parent) -> void {
    for (const Child& child : parent.children) {
      if (!seen.insert(child.node.get()).second) continue;
      if (child.node->category == category) ++counts[child.node->type];
      self(self, *child.node);
    }
  };
  visit(visit, node);
  return counts;
}

std::string describe_counts(const std::map<std::string, size_t>& counts) {
  std::string text;
  for (const auto& [name, count] : counts) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, name);
  return text.empty() ? "none" : text;
}

/// Which objects a medium fills, by their ids.
std::string places_of(const Scene& scene, const Medium* medium) {
  std::string text;
  size_t unnamed = 0;
  for (const Object& object : scene.objects()) {
    if (object.interior.get() != medium && object.exterior.get() != medium) continue;
    if (object.id.empty())
      ++unnamed;
    else
      text += (text.empty() ? "" : ", ") + object.id;
  }
  if (unnamed > 0)
    text += fmt::format("{}{} unnamed {}", text.empty() ? "" : ", ", unnamed, unnamed == 1 ? "shape" : "shapes");
  if (scene.sensor_medium() == medium) text += text.empty() ? "around the sensor" : "; around the sensor";
  return text;
}

void print_medium(const Scene& scene, const Surroundings& surroundings) {
  const Medium& m = *surroundings.medium;
  const Spectrum sigma_t = m.sigma_t(), sigma_s = m.sigma_s();
  Spectrum path, albedo;
  for (int c = 0; c < kChannels; ++c) {
    path[c] = 1 / sigma_t[c];
    albedo[c] = sigma_t[c] > 0 ? sigma_s[c] / sigma_t[c] : 0;
  }
  fmt::print(kLine, "medium", places_of(scene, &m));
  const float extent = extent_of(scene, &m);
  fmt::print("{:<12}   mean free path {} scene units{}, albedo {}, mean cosine {:.3g}\n", "", rgb(path),
             extent > 0 ? fmt::format(", {} of its extent ({:.4g})", rgb(path / extent), extent) : "", rgb(albedo),
             m.phase().mean_cosine());
  // For tables of multiple scattering.
  constexpr float kFar = 1.25f;
  const float ratio = brightness_without_end(scene, m);
  if (ratio > kFar || ratio < 1 / kFar)
    fmt::print(
        "{:<12}   without its end it would reflect about {:.2g} times as much from order 3 on: tables need boundary = "
        "image\n",
        "", ratio);
}

void print_lights(const Scene& scene, const SceneNode& root) {
  size_t inside = 0;
  for (const Emitter* emitter : scene.emitters())
    if (!emitter->is_at_infinity() && scene.medium_at(emitter->bounds().center())) ++inside;
  const std::string where = inside > 0 ? fmt::format("; {} inside media", inside) : "";
  fmt::print(kLine, "lights", describe_counts(count_types(root, Category::kEmitter)) + where);
}

/// Which integrator suits, and what else a colleague would say.
void print_advice(const Scene& scene, const IntegratorDescription& description, const Integrator& integrator) {
  const Advice advice = suggest_integrator(scene);
  fmt::print(kLine, "suited", fmt::format("{}: {}", advice.integrator, advice.why));
  std::vector<std::string> warnings = missed_light(description, integrator, scene);
  if (const std::string ignored = ignored_media(description, integrator, scene); !ignored.empty())
    warnings.push_back(ignored);
  for (std::string& finding : check_scene(scene)) warnings.push_back(std::move(finding));
  if (scene.emitters().empty() &&
      !std::any_of(scene.media().begin(), scene.media().end(), [](const Surroundings& s) { return s.medium->emits(); }))
    warnings.emplace_back("nothing shines: the picture will be black");
  for (const std::string& warning : warnings) fmt::print(kLine, "warning", warning);
}

void print_film(const Scene& scene) {
  const FilmSettings& film = scene.film();
  std::string text = fmt::format("{} x {} pixels", film.size.x, film.size.y);
  if (film.crop_size.x > 0)
    text += fmt::format(", crop of {} x {} at ({}, {})", film.crop_size.x, film.crop_size.y, film.crop_offset.x,
                        film.crop_offset.y);
  const Vec2i size = film.image_size();
  fmt::print(kLine, "film",
             fmt::format("{}; {} samples per pixel, {} per pass", text, scene.sample_count(), samples_per_pass(size)));
}

/// What a render will need: the scene as it stands in memory now, and the films of total, pass and snapshot.
void print_memory(const Scene& scene, const Integrator& integrator) {
  const Vec2i size = scene.film().image_size();
  const double films = 3.0 * size.x * size.y *
                       static_cast<double>(sizeof(PixelSums) + sizeof(double) * film_layers(scene, integrator).size());
  fmt::print(kLine, "memory",
             fmt::format("about {} to render", memory(films + static_cast<double>(process_peak_memory()))));
}

int run_info(const SceneChoice& choice) {
  LoadedScene loaded = open_scene(choice);
  const SceneNode& root = *loaded.document->root;
  const IntegratorSetup setup = make_integrator(loaded.integrator, loaded.document.get());
  const Scene scene(std::move(loaded.parts));
  size_t primitives = 0;
  for (const Object& object : scene.objects()) primitives += object.shape->primitive_count();
  fmt::print(kLine, "scene", choice.name());
  fmt::print(kLine, "files", loaded.files.size());
  fmt::print(kLine, "integrator", describe_integrator(*loaded.integrator.node));
  print_film(scene);
  fmt::print(kLine, "shapes",
             fmt::format("{} with {} primitives: {}", scene.objects().size(), primitives,
                         describe_counts(count_types(root, Category::kShape))));
  const Bounds3& bounds = scene.rays().bounds();
  if (!bounds.isEmpty())
    fmt::print(kLine, "bounds",
               fmt::format("{} to {}, radius {:.4g}", point(bounds.min), point(bounds.max), scene.radius()));
  fmt::print(kLine, "bsdfs", describe_counts(count_types(root, Category::kBsdf)));
  print_lights(scene, root);
  if (scene.media().empty()) fmt::print(kLine, "media", "none");
  for (const Surroundings& surroundings : scene.media()) print_medium(scene, surroundings);
  print_memory(scene, *setup.integrator);
  print_advice(scene, loaded.integrator, *setup.integrator);
  return kExitDone;
}

}  // namespace

Command add_info_command(CLI::App& app) {
  auto choice = std::make_shared<SceneChoice>();
  CLI::App* command = app.add_subcommand("info", "say what a scene holds, without rendering it");
  command->add_option("SCENE", choice->file, "a Mitsuba 3 scene file; left out: the scene inside the program");
  command->add_option("-D,--define", choice->definitions, "NAME=VALUE sets $NAME of the scene")
      ->expected(1)
      ->take_all();
  command->add_option("--integrator", choice->integrator, "TYPE[,KEY=VALUE]... in the place of the scene's integrator");
  command->add_option("--size", choice->size, "WIDTHxHEIGHT of the image in pixels");
  return [choice](const CommandLine&) { return run_info(*choice); };
}

}  // namespace turbid
