#include "integrator/advice.h"

#include <fmt/format.h>

#include <numbers>

#include "core/warp.h"

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

/// Leaves no choice of direction, and is no mere passage.
bool is_specular(const Bsdf& bsdf) {
  constexpr lobe::Flags kPassage = lobe::kNull | lobe::kDelta | lobe::kTransmission;
  return (bsdf.flags() & lobe::kDelta) && !(bsdf.flags() & lobe::kSmooth) && bsdf.flags() != kPassage;
}

/// A lamp in a glass: of the straight lines from its middle, the share that come to something smooth that bends light.
float share_behind_glass(const Scene& scene, const Emitter& emitter) {
  if (emitter.is_at_infinity()) return 0;
  constexpr int kLines = 128;
  int behind = 0;
  for (int i = 0; i < kLines; ++i) {
    // Evenly over the sphere: a spiral of the golden ratio.
    const float turn = static_cast<float>(i) * std::numbers::phi_v<float>;
    const Vec3 direction = square_to_sphere({turn - std::floor(turn), (static_cast<float>(i) + 0.5f) / kLines});
    Ray ray{emitter.bounds().center(), direction};
    while (const Hit hit = scene.rays().intersect(ray)) {
      const Object& object = scene.object(hit);
      const bool passes = object.emitter.get() == &emitter || (object.bsdf->flags() & lobe::kNull);
      if (!passes) {
        behind += is_specular(*object.bsdf) && (object.bsdf->flags() & lobe::kTransmission);
        break;
      }
      ray = {object.shape->surface_point(ray, hit).leave(direction), direction};
    }
  }
  return static_cast<float>(behind) / kLines;
}

}  // namespace

PathSupport asked_for(const Scene& scene) {
  PathSupport result{.specular_at_sensor = false, .glowing_media = false};
  for (const Object& object : scene.objects())
    if (is_specular(*object.bsdf)) result.specular_at_sensor = true;
  for (const Emitter* emitter : scene.emitters()) {
    if (!emitter->can_be_hit()) result.specular_at_delta_light = result.specular_at_sensor;
    if (!emitter->can_be_aimed_at()) result.beams = true;
  }
  result.specular_at_both_ends = result.specular_at_delta_light;
  for (const Surroundings& m : scene.media())
    if (m.medium->emits()) result.glowing_media = true;
  return result;
}

std::vector<std::string> missed_light(const IntegratorDescription& description, const Integrator& integrator,
                                      const Scene& scene) {
  const PathSupport asked = asked_for(scene), has = integrator.support();
  const std::string name = image_integrator(description);
  std::vector<std::string> result;
  const auto note = [&](bool missed, const std::string& what, const char* better) {
    if (missed) result.push_back(fmt::format("integrator '{}' misses {}: '{}' finds it", name, what, better));
  };
  note(asked.specular_at_delta_light && !has.specular_at_delta_light,
       "the light of point, spot and directional lights that comes through smooth glass or off mirrors", "bdpt");
  note(asked.beams && !has.beams, "the light of collimated beams", "bdpt");
  note(asked.specular_at_sensor && !has.specular_at_sensor, "what is seen in mirrors and through smooth glass", "bdpt");
  note(asked.glowing_media && !has.glowing_media, "the light of glowing media", "volpath");
  return result;
}

float extent_of(const Scene& scene, const Medium* medium) {
  float extent = 0;
  for (const Object& object : scene.objects())
    if (object.interior.get() == medium) extent = std::max(extent, max_component(object.shape->bounds().size()));
  return extent;
}

Advice suggest_integrator(const Scene& scene) {
  if (scene.media().empty()) return {"path", "there are no media"};
  Advice advice{"volpath", ""};
  const Surroundings* worst = nullptr;
  bool blind = false;
  float collisions = 0;
  for (const Surroundings& medium : scene.media()) {
    blind = blind || medium.blind;
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
  constexpr float kMuch = 0.25f;
  const bool lamp_in_glass = std::any_of(scene.emitters().begin(), scene.emitters().end(), [&](const Emitter* emitter) {
    return share_behind_glass(scene, *emitter) > kMuch;
  });
  const PathSupport asked = asked_for(scene);
  if (asked.beams || asked.specular_at_delta_light || lamp_in_glass) {
    advice.integrator = "bdpt";
    advice.why = lamp_in_glass
                     ? "a light stands behind smooth glass, where paths from the sensor find it by chance alone"
                     : "some light can be followed from its source alone";
  }
  constexpr float kMany = 20;
  if (collisions > kMany)
    advice.why += fmt::format("; paths are long, some {:.2g} collisions in the densest medium", collisions);
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
