#include "surface/tilted.h"

#include <algorithm>
#include <stdexcept>

namespace turbid {
namespace {

constexpr float kBelowOne = 0x1.fffffep-1f;

/// The frame around a local normal with its first axis near that of the frame that it is local to.
Frame frame_around(const Vec3& n) {
  const Vec3 along = Vec3(1, 0, 0) - n * n.x;
  const float size = length(along);
  const Vec3 s = size > 1e-6f ? along / size : Vec3(0, 1, 0);
  return {s, cross(n, s), n};
}

bool same_side(float a, float b) { return (a > 0 && b > 0) || (a < 0 && b < 0); }
/// Do both normals, that of the frame and +z, see v from the same side?
bool agrees(const Frame& frame, const Vec3& v) { return same_side(dot(v, frame.n), v.z); }

float tan_squared(const Vec3& v) { return (1 - sqr(v.z)) / sqr(v.z); }

}  // namespace

/// The tilted frame, and the one with the mirrored normal where that may be needed.
struct Tilted::Frames {
  Frame plain, flipped;
  bool may_flip;

  /// The frame in which light goes that reaches the sensor along wo.
  const Frame& of(const Vec3& wo) const { return may_flip && !agrees(plain, wo) ? flipped : plain; }
  /// Probability of the flipped frame when wo is not known yet (importance mode): about the share of directions that
  /// need it.
  float prob_flipped(const Vec3& wi) const {
    if (!may_flip || !agrees(flipped, wi)) return 0;
    return agrees(plain, wi) ? 0.5f * safe_sqrt(1 - sqr(plain.n.z)) : 1;
  }
};

Tilted::Tilted(BsdfPtr nested, const TiltSettings& settings) : nested_(std::move(nested)), settings_(settings) {
  if (!nested_) throw std::invalid_argument("a tilted material needs a nested one");
}

Tilted::Frames Tilted::frames(const SurfacePoint& point) const {
  const Vec3 direction = tilt(point);
  const float inverse = 1 / length(direction);
  const Vec3 n = inverse > 0 && std::isfinite(inverse) ? direction * inverse : Vec3(0, 0, 1);
  const bool may_flip = settings_.flip_invalid_normals && (n.x != 0 || n.y != 0);
  const Frame plain = frame_around(n);
  return {plain, may_flip ? frame_around(Vec3(-n.x, -n.y, n.z)) : plain, may_flip};
}

SurfacePoint Tilted::tilted_point(const SurfacePoint& point, const Frame& frame) const {
  SurfacePoint result = point;
  result.shading = {point.to_world(frame.s), point.to_world(frame.t), point.to_world(frame.n)};
  return result;
}

float Tilted::shadowing(const Vec3& normal, const Vec3& wi) const {
  if (!settings_.use_shadowing_function) return 1;
  // Estevez et al. 2019: the tilted normals as facets of a rough surface, masked towards the light as by Smith's GGX.
  const float alpha2 = std::min(0.125f * tan_squared(normal), 1.0f);
  return 2 / (1 + std::sqrt(1 + alpha2 * tan_squared(wi)));
}

Bsdf::Eval Tilted::importance(const SurfacePoint& point, const Frames& frames, const Vec3& given,
                              const Vec3& chosen) const {
  Eval result;
  const Frame& right = frames.of(chosen);
  const float prob_flipped = frames.prob_flipped(given);
  for (const bool flipped : {false, true}) {
    const Frame& frame = flipped ? frames.flipped : frames.plain;
    const float prob = flipped ? prob_flipped : 1 - prob_flipped;
    if (!agrees(frame, given) || !agrees(frame, chosen) || (flipped && !frames.may_flip)) continue;
    const Vec3 from = frame.to_local(given), to = frame.to_local(chosen);
    const Eval nested = nested_->eval(tilted_point(point, frame), from, to, TransportMode::kImportance);
    result.pdf_w += prob * nested.pdf_w;
    if (&frame == &right)
      result.value = nested.value * (chosen.z / to.z * (from.z / given.z) * shadowing(frame.n, given));
  }
  return result;
}

Bsdf::Eval Tilted::eval(const SurfacePoint& point, const Vec3& given, const Vec3& chosen, TransportMode mode) const {
  const Frames both = frames(point);
  if (mode == TransportMode::kImportance) return importance(point, both, given, chosen);
  const Frame& frame = both.of(given);
  if (!agrees(frame, given) || !agrees(frame, chosen)) return {};
  Eval result = nested_->eval(tilted_point(point, frame), frame.to_local(given), frame.to_local(chosen), mode);
  result.value *= shadowing(frame.n, chosen);
  return result;
}

std::optional<BsdfSample> Tilted::sample(const SurfacePoint& point, const Vec3& given, float u_lobe, const Vec2& u,
                                         TransportMode mode) const {
  const Frames both = frames(point);
  const bool forward = mode == TransportMode::kImportance;
  const float prob_flipped = forward ? both.prob_flipped(given) : 0;
  const bool flip = u_lobe < prob_flipped;
  if (forward) u_lobe = flip ? u_lobe / prob_flipped : (u_lobe - prob_flipped) / (1 - prob_flipped);
  const Frame& frame = forward ? (flip ? both.flipped : both.plain) : both.of(given);
  if (!agrees(frame, given)) return std::nullopt;

  const Vec3 from = frame.to_local(given);
  std::optional<BsdfSample> result =
      nested_->sample(tilted_point(point, frame), from, std::min(u_lobe, kBelowOne), u, mode);
  if (!result) return std::nullopt;
  const bool straight = (result->flags & lobe::kNull) != 0;
  const Vec3 to = result->direction;
  result->direction = straight ? -given : frame.to_world(to);
  if (!same_side(to.z, result->direction.z)) return std::nullopt;
  if (!forward) {
    if (!straight) result->weight *= shadowing(frame.n, result->direction);
    return result;
  }
  if (!(result->flags & lobe::kDelta)) {
    const Eval whole = importance(point, both, given, result->direction);
    if (!(whole.pdf_w > 0)) return std::nullopt;
    result->weight = whole.value / whole.pdf_w;
    result->pdf_w = whole.pdf_w;
    return result;
  }
  if (&frame != &both.of(result->direction)) return std::nullopt;  // light goes that way in the other frame
  result->weight /= flip ? prob_flipped : 1 - prob_flipped;
  if (!straight) result->weight *= result->direction.z / to.z * (from.z / given.z) * shadowing(frame.n, given);
  return result;
}

Spectrum Tilted::null_transmission(const SurfacePoint& point, const Vec3& given) const {
  if (!(nested_->flags() & lobe::kNull)) return Spectrum(0.0f);
  const Frames both = frames(point);
  const Frame& frame = both.of(given);
  if (!agrees(frame, given)) return Spectrum(0.0f);
  return nested_->null_transmission(tilted_point(point, frame), frame.to_local(given));
}

}  // namespace turbid
