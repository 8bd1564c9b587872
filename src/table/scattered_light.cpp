#include "table/scattered_light.h"

#include <cmath>

namespace turbid {
namespace {

/// Below this optical length a stretch of light is looked up as collisions along it: b(z) - e^-D b(z - D) would be the
/// small difference of large numbers, and their noise grows by 1/(1 - e^-D).
constexpr float kShort = 1;
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
    return stretch<float>(x, axis, axis, depth, w);
  }
  Lanes from_collision(const Vec3Lanes& x, const Vec3& axis, const Vec3& w) const override {
    return collision_.eval(x, axis, w);
  }
  Lanes from_stretch(const Vec3Lanes& x, const Vec3& axis, float depth, const Vec3& w) const override {
    return stretch<Lanes>(x, lanes_of(axis), axis, depth, w);
  }

 private:
  template <class Real, class Vector>
  Real stretch(const Vector& x, const Vector& along, const Vec3& axis, float depth, const Vec3& w) const {
    if (depth < kShort)
      return collisions_of_stretch(depth, x, along, [&](const Vector& at) { return collision_.eval(at, axis, w); });
    const Real whole = ray_.eval(x, axis, w);
    return depth < kLong ? whole - std::exp(-depth) * ray_.eval(x - along * Real(depth), axis, w) : whole;
  }

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

}  // namespace turbid
