#include "table/scattered_light.h"

#include <cmath>

namespace turbid {
namespace {

/// Below these optical lengths a stretch of light is looked up as collisions at their mean depth, and at three depths:
/// b(z) - e^-D b(z - D) would be the small difference of large numbers, and their noise grows by 1/(1 - e^-D).
constexpr float kShortest = 0.2f, kShort = 1;
/// Beyond it nothing is left of the light.
constexpr float kLong = 30;

class ExactLight final : public ScatteredLight {
 public:
  ExactLight(const ScatteringTable& table, double albedo, int from_order)
      : collision_(table, SourceKind::kCollision, albedo, from_order),
        ray_(table, SourceKind::kRay, albedo, from_order) {}

  float from_collision(const Vec3& x, const Vec3& axis, const Vec3& w) const override {
    return collision_.eval(x, axis, w);
  }
  float from_stretch(const Vec3& x, const Vec3& axis, float depth, const Vec3& w) const override {
    if (depth < kShort) return collisions_of_stretch(collision_, depth, x, axis, w);
    const float whole = ray_.eval(x, axis, w);
    return depth < kLong ? whole - std::exp(-depth) * ray_.eval(x - axis * depth, axis, w) : whole;
  }

 private:
  LobeField collision_, ray_;
};

}  // namespace

ChannelLights exact_lights(const HomogeneousMedium& medium, const ScatteringTable& table, int from_order) {
  ChannelLights lights;
  for (size_t c = 0; c < kChannels; ++c) {
    const float albedo = medium.albedo()[static_cast<int>(c)];
    if (!(albedo > 0)) continue;
    for (size_t same = 0; same < c; ++same)
      if (medium.albedo()[static_cast<int>(same)] == albedo) lights[c] = lights[same];
    if (!lights[c]) lights[c] = std::make_shared<ExactLight>(table, static_cast<double>(albedo), from_order);
  }
  return lights;
}

float collisions_of_stretch(const LightField& collision, float depth, const Vec3& x, const Vec3& axis, const Vec3& w) {
  const float collided = -std::expm1(-depth);
  if (depth < kShortest) {
    const float mean_depth = depth < 1e-2f ? depth / 2 : 1 - depth * std::exp(-depth) / collided;
    return collided * collision.eval(x - axis * mean_depth, axis, w);
  }
  // Gauss-Legendre in the probability to have collided.
  float sum = 0;
  for (const auto& [node, weight] : {std::pair{0.1127017f, 5.0f / 18}, {0.5f, 8.0f / 18}, {0.8872983f, 5.0f / 18}})
    sum += weight * collision.eval(x + axis * std::log1p(-node * collided), axis, w);
  return collided * sum;
}

}  // namespace turbid
