#include "integrator/advice.h"

#include <fmt/format.h>

namespace turbid {
namespace {

/// About how often light that enters collides before it leaves or is absorbed. Without absorption the mean length of
/// such paths in a convex body is its mean chord, however it scatters; for a ball that is 2/3 of its width.
float expected_collisions(const Scene& scene, const Surroundings& surroundings) {
  const float chord = 2.0f / 3 * extent_of(scene, surroundings.medium) / surroundings.mean_free_path;
  const Medium& m = *surroundings.medium;
  const float albedo = m.sigma_t().max() > 0 ? m.sigma_s().max() / m.sigma_t().max() : 0;
  return albedo < 1 ? std::min(chord, 1 / (1 - albedo)) : chord;
}

}  // namespace

float extent_of(const Scene& scene, const Medium* medium) {
  float extent = 0;
  for (const Object& object : scene.objects())
    if (object.interior.get() == medium) extent = std::max(extent, max_component(object.shape->bounds().size()));
  return extent;
}

Advice suggest_integrator(const Scene& scene) {
  if (scene.media().empty()) return {"path", "there are no media", {}};
  Advice advice{"volpath", "", {}};
  const Surroundings* worst = nullptr;
  bool blind = false, all_blind = true;
  float collisions = 0;
  for (const Surroundings& medium : scene.media()) {
    blind = blind || medium.blind;
    all_blind = all_blind && medium.blind;
    const float expected = expected_collisions(scene, medium);
    if (!worst || expected > collisions) {
      worst = &medium;
      collisions = expected;
    }
  }
  if (blind)
    advice.why =
        "paths from the sensor find the lights by chance once they are out of the medium, whose boundary bends "
        "light: large lights give little noise, small ones much";
  else
    advice.why = "shadow rays reach the lights through media and invisible boundaries";
  constexpr float kMany = 20;
  if (collisions > kMany)
    advice.why += fmt::format("; paths are long, some {:.2g} collisions in the densest medium", collisions);
  const bool delta = std::any_of(scene.emitters().begin(), scene.emitters().end(),
                                 [](const Emitter* emitter) { return !emitter->can_be_hit(); });
  if (blind && delta)
    advice.limits.push_back(fmt::format(
        "point, spot and directional lights cannot be met by chance: {} behind smooth glass stay dark under them; give "
        "the light a size or the boundary a roughness",
        all_blind ? "the media" : "media"));
  return advice;
}

std::string image_integrator(const IntegratorDescription& description) {
  const SceneNode* node = description.node.get();
  for (size_t i = 0; i < node->children.size();) {
    if (node->children[i].node->category != Category::kIntegrator) {
      ++i;
      continue;
    }
    node = node->children[i].node.get();
    i = 0;
  }
  return node->type;
}

std::string ignored_media(const IntegratorDescription& description, const Integrator& integrator, const Scene& scene) {
  if (integrator.sees_media() || scene.media().empty()) return {};
  const size_t count = scene.media().size();
  return fmt::format("integrator '{}' ignores media, and the scene has {}: 'volpath' shows them (--integrator volpath)",
                     image_integrator(description), count == 1 ? "one" : std::to_string(count));
}

}  // namespace turbid
