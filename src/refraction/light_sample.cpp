#include "refraction/light_sample.h"

namespace turbid {
namespace {
constexpr int kMostTries = 1000;
}

std::optional<LightSample> LightSample::draw(const Scene& scene, const Emitter& emitter, float prob, Rng& rng) {
  const auto next_2d = [&] {
    const float u = rng.next_float();
    return Vec2(u, rng.next_float());
  };
  const Vec2 u_first = next_2d(), u_second = next_2d();
  if (!emitter.can_be_aimed_at()) return std::nullopt;
  LightSample result;
  result.emitter_ = &emitter;
  result.inverse_prob_ = 1 / prob;
  if (emitter.is_at_infinity()) {
    const auto light = emitter.sample_direct(scene.center(), u_first);
    if (!light) return std::nullopt;
    result.point_ = {V3d(light->wi).normalized(), true};
    result.irradiance_ = light->weight;
    return result;
  }
  auto emission = emitter.sample_emission(u_first, u_second);
  // Only its origin counts; a projector gives none where the drawn direction is black.
  for (int i = 0; i < kMostTries && !emission; ++i) emission = emitter.sample_emission(next_2d(), next_2d());
  if (!emission) return std::nullopt;
  result.emission_ = *emission;
  result.point_ = {V3d(emission->origin), false};
  return result;
}

Spectrum LightSample::emitted(const Vec3& direction) const {
  if (at_infinity()) return irradiance_ * inverse_prob_;
  const auto intensity = emitter_->emission_towards(emission_, direction);
  return intensity ? *intensity * inverse_prob_ : Spectrum(0.0f);
}

}  // namespace turbid
