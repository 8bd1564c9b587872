#include "manylight/segment_pair.h"

#include <array>

namespace turbid {
namespace {

// Loops over strata have no branches and no calls, so that they become vector code: all strata of a pair at once.
constexpr int kStrata = 8;
using Strata = std::array<float, kStrata>;
constexpr float kEven = 0.1f;  ///< share of the strata that lobes do not weigh: no place is left out

/// Henyey-Greenstein without its constant factor.
inline float lobe_of(float g, float mu) {
  const float base = std::max(1 + g * g - 2 * g * mu, 1e-6f);
  return 1 / (base * std::sqrt(base));
}

/// e^asinh(x); sums of like signs, so that no digit is lost.
inline float exp_asinh(float x) {
  const float sum = std::abs(x) + std::sqrt(x * x + 1);
  return x < 0 ? 1 / sum : sum;
}

/// An angle for weights by its cosine and sine, within 3e-4 of itself: acos (Abramowitz and Stegun, 4.4.45), which
/// loses the digits of small angles.
inline float rough_angle(float c, float s) {
  if (c > 0.95f) return s * (1 + s * s * (1.0f / 6));
  const float a = std::min(std::abs(c), 1.0f);
  const float r = std::sqrt(1 - a) * (1.5707288f + a * (-0.2121144f + a * (0.0742610f - 0.0187293f * a)));
  return c < 0 ? kPi - r : r;
}

/// Probabilities of strata, from weights of any scale.
Strata with_even_share(const Strata& weights) {
  float sum = 0;
  for (const float w : weights) sum += w;
  Strata probs;
  const float scale = sum > 0 && std::isfinite(sum) ? (1 - kEven) / sum : 0;
  const float even = scale > 0 ? kEven / kStrata : 1.0f / kStrata;
  for (int j = 0; j < kStrata; ++j) probs[static_cast<size_t>(j)] = weights[static_cast<size_t>(j)] * scale + even;
  return probs;
}

/// A coordinate in [0, 1) whose strata have these probabilities, and its density.
struct Coordinate {
  float x;
  float pdf;
};
Coordinate sample_strata(const Strata& probs, float u) {
  size_t j = 0;
  while (j + 1 < kStrata && u >= probs[j]) u -= probs[j++];
  const float within = std::min(u / probs[j], 0x1.fffffep-1f);
  return {(static_cast<float>(j) + within) / kStrata, probs[j] * kStrata};
}
float pdf_of(const Strata& probs, float x) {
  const int j = std::clamp(static_cast<int>(x * kStrata), 0, kStrata - 1);
  return probs[static_cast<size_t>(j)] * kStrata;
}

/// A segment seen from a point: foot of the perpendicular at t = foot, `distance` away, towards `normal`.
struct View {
  View(const Ray& segment, const Vec3& p) {
    const Vec3 way = segment.origin - p;
    foot = -dot(way, segment.direction);
    const Vec3 perpendicular = way + segment.direction * foot;
    // On the line itself any distance will do that the density is told, too.
    distance = std::max(length(perpendicular), 1e-6f * std::max(segment.t_max, 1e-20f));
    normal = perpendicular / distance;
    angle = angle_to(segment.t_max);
  }
  /// The angle between the lines to the segment's beginning and to t; without the cancellation that a difference of
  /// angles has where the segment lies nearly along the line of sight.
  float angle_to(float t) const { return std::atan2(distance * t, sqr(distance) - foot * (t - foot)); }
  float t_at(float tangent) const { return tangent * (sqr(foot) + sqr(distance)) / (distance + foot * tangent); }

  float foot, distance, angle;
  Vec3 normal;
};

/// The probabilities of strata of the angle: lobes at both ends of the line. At the segment light is deflected between
/// the line and the segment's direction, the same cosine from either end; at p between `other` (zero: no lobe) and it.
Strata weigh_angles(const View& view, const Ray& segment, float g, const Vec3& other, float g_other) {
  Strata cosines, sines, weights;
  const float half = view.angle / (2 * kStrata), inverse = 1 / std::hypot(view.foot, view.distance);
  const float ch = std::cos(half), sh = std::sin(half), cs = ch * ch - sh * sh, ss = 2 * ch * sh;
  // Cosine and sine from the perpendicular, in the middle of the first stratum.
  float c = (view.distance * ch + view.foot * sh) * inverse, s = (view.distance * sh - view.foot * ch) * inverse;
  for (size_t j = 0; j < kStrata; ++j) {
    cosines[j] = c;
    sines[j] = s;
    const float next = c * cs - s * ss;
    s = s * cs + c * ss;
    c = next;
  }
  const float along_normal = dot(view.normal, other), along_segment = dot(segment.direction, other);
  // The line goes from p to the segment; light on the segment goes along its direction and then back to p, or the
  // sensor's walk goes along it while light comes from p: mu = -sin either way.
  for (size_t j = 0; j < kStrata; ++j)
    weights[j] = lobe_of(g, -sines[j]) * lobe_of(g_other, cosines[j] * along_normal + sines[j] * along_segment);
  return with_even_share(weights);
}

PlaceOnSegment place_in(const View& view, const Ray& segment, const Coordinate& at) {
  const float t = std::clamp(view.t_at(std::tan(at.x * view.angle)), 0.0f, segment.t_max);
  const double d = static_cast<double>(view.distance), along = static_cast<double>(t - view.foot);
  return {t, static_cast<double>(at.pdf) * d / (static_cast<double>(view.angle) * (d * d + along * along))};
}

double density_in(const View& view, const Strata* probs, float t) {
  const float x = view.angle_to(t) / view.angle;
  const double d = static_cast<double>(view.distance), along = static_cast<double>(t - view.foot);
  return static_cast<double>(probs ? pdf_of(*probs, x) : 1) * d /
         (static_cast<double>(view.angle) * (d * d + along * along));
}

/// The first step of a pair: x in [0, 1) maps to a place on the light's segment by a density 1/D; strata in x.
class LightMap {
 public:
  LightMap(const Ray& light, const Ray& sensor, const SegmentLobes& lobes) : light_(light) {
    // Where the two lines come nearest.
    const Vec3 between = light.origin - sensor.origin;
    const float across = dot(light.direction, sensor.direction);
    constexpr float kParallel = 1e-10f;
    sine2_ = length_squared(cross(light.direction, sensor.direction));
    const bool parallel = sine2_ < kParallel;
    sine2_ = std::max(sine2_, kParallel);
    const float d = dot(between, light.direction), e = dot(between, sensor.direction);
    nearest_ = (across * e - d) / sine2_;
    const Vec3 from = light.origin + light.direction * nearest_ - sensor.origin;
    const Vec3 gap = from - sensor.direction * dot(from, sensor.direction);
    h2_ = std::max(length_squared(gap), sqr(1e-6f * std::max(light.t_max, 1e-20f)));
    scale_ = std::sqrt(sine2_ / h2_);
    begin_ = exp_asinh(-nearest_ * scale_);
    range_ = std::log(exp_asinh((light.t_max - nearest_) * scale_) / begin_);
    // Seen from far away all places are alike, and the difference would lose its digits.
    constexpr float kLeastRange = 0.05f;
    flat_ = parallel || !(range_ > kLeastRange);
    if (lobes.g_light != 0 || lobes.g_sensor != 0) weigh(sensor, lobes);
  }

  PlaceOnSegment sample(float u) const {
    const Coordinate at = weighed_ ? sample_strata(probs_, u) : Coordinate{u, 1};
    const float t = std::clamp(place(at.x), 0.0f, light_.t_max);
    return {t, static_cast<double>(at.pdf) * density(t)};
  }
  double pdf(float t) const {
    const float x = flat_ ? t / light_.t_max : std::log(exp_asinh((t - nearest_) * scale_) / begin_) / range_;
    return static_cast<double>(weighed_ ? pdf_of(probs_, x) : 1) * density(t);
  }

 private:
  float place(float x) const {
    if (flat_) return x * light_.t_max;
    const float e = begin_ * std::exp(x * range_);
    return nearest_ + 0.5f * (e - 1 / e) / scale_;
  }
  /// dx/dt.
  double density(float t) const {
    if (flat_) return 1 / static_cast<double>(light_.t_max);
    const double s = static_cast<double>(scale_), along = static_cast<double>(t - nearest_) * s;
    return s / (static_cast<double>(range_) * std::sqrt(1 + along * along));
  }

  void weigh(const Ray& sensor, const SegmentLobes& lobes) {
    // e^x at the middles of the strata by products; sinh from both.
    Strata middles;
    if (flat_) {
      for (size_t j = 0; j < kStrata; ++j) middles[j] = (static_cast<float>(j) + 0.5f) / kStrata * light_.t_max;
    } else {
      float up = begin_ * std::exp(range_ / (2 * kStrata));
      const float step = std::exp(range_ / kStrata);
      for (size_t j = 0; j < kStrata; ++j) {
        middles[j] = nearest_ + 0.5f * (up - 1 / up) / scale_;
        up *= step;
      }
    }
    const Vec3 &l = light_.direction, &d = sensor.direction, start = light_.origin - sensor.origin;
    const float across = dot(l, d), start_d = dot(start, d);
    Strata weights;
    for (size_t j = 0; j < kStrata; ++j) {
      const float t = middles[j];
      // From there, in the plane of the sensor's line: `along` to both its ends, D across; as in View.
      const float foot = start_d + t * across;
      const Vec3 p = start + l * t;
      const float px = p.x - d.x * foot, py = p.y - d.y * foot, pz = p.z - d.z * foot;
      const float d2 = std::max(px * px + py * py + pz * pz, 1e-20f), inverse_d = 1 / std::sqrt(d2);
      const float a = -foot, b = sensor.t_max - foot;
      const float ia = 1 / std::sqrt(d2 + a * a), ib = 1 / std::sqrt(d2 + b * b), distance = d2 * inverse_d;
      const float ca = distance * ia, sa = a * ia, cb = distance * ib, sb = b * ib;
      const float cm = ca + cb, sm = sa + sb, im = 1 / std::sqrt(std::max(cm * cm + sm * sm, 1e-12f));
      const float normal_l = -(px * l.x + py * l.y + pz * l.z) * inverse_d;
      const auto lobes_at = [&](float c, float s) {
        return lobe_of(lobes.g_sensor, -s) * lobe_of(lobes.g_light, c * normal_l + s * across);
      };
      const float angle = rough_angle(ca * cb + sa * sb, distance * sensor.t_max * ia * ib);
      weights[j] = angle * (lobes_at(ca, sa) + 2 * lobes_at(cm * im, sm * im) + lobes_at(cb, sb));
    }
    probs_ = with_even_share(weights);
    weighed_ = true;
  }

  const Ray& light_;
  float sine2_, nearest_, h2_, scale_;
  float begin_, range_;  ///< e^asinh at the beginning, and how much the exponent grows
  bool weighed_ = false, flat_ = false;
  Strata probs_{};
};

}  // namespace

PlaceOnSegment place_towards(const Ray& segment, const Vec3& p, float g, float u) {
  const View view(segment, p);
  if (!(view.angle > 0)) return {};
  if (g == 0) return place_in(view, segment, {u, 1});
  return place_in(view, segment, sample_strata(weigh_angles(view, segment, g, Vec3(0), 0), u));
}

double pdf_towards(const Ray& segment, const Vec3& p, float g, float t) {
  const View view(segment, p);
  if (!(view.angle > 0)) return 0;
  if (g == 0) return density_in(view, nullptr, t);
  const Strata probs = weigh_angles(view, segment, g, Vec3(0), 0);
  return density_in(view, &probs, t);
}

SegmentPair sample_pair(const Ray& light, const Ray& sensor, const SegmentLobes& lobes, const Vec2& u) {
  const PlaceOnSegment first = LightMap(light, sensor, lobes).sample(u.x);
  const View view(sensor, light.at(first.t));
  if (!(view.angle > 0) || !(first.pdf_t > 0)) return {};
  Coordinate at{u.y, 1};
  if (lobes.g_light != 0 || lobes.g_sensor != 0)
    at = sample_strata(weigh_angles(view, sensor, lobes.g_sensor, light.direction, lobes.g_light), u.y);
  const PlaceOnSegment second = place_in(view, sensor, at);
  return {first.t, second.t, first.pdf_t * second.pdf_t};
}

double pdf_pair(const Ray& light, const Ray& sensor, const SegmentLobes& lobes, float on_light, float on_sensor) {
  const View view(sensor, light.at(on_light));
  if (!(view.angle > 0)) return 0;
  const double first = LightMap(light, sensor, lobes).pdf(on_light);
  if (lobes.g_light == 0 && lobes.g_sensor == 0) return first * density_in(view, nullptr, on_sensor);
  const Strata probs = weigh_angles(view, sensor, lobes.g_sensor, light.direction, lobes.g_light);
  return first * density_in(view, &probs, on_sensor);
}

}  // namespace turbid
