#include "manylight/segment_pairs.h"

#include <array>

#include "manylight/lanes.h"

namespace turbid {
namespace {

// As in segment_pair.cpp, which says why; here strata are a loop and pairs the lanes.
constexpr int kStrata = 8;
constexpr float kEven = 0.1f;
using Strata = std::array<Lanes, kStrata>;

struct Vec3Lanes {
  Lanes x, y, z;
  Vec3Lanes operator-(const Vec3Lanes& o) const { return {x - o.x, y - o.y, z - o.z}; }
  Vec3Lanes operator+(const Vec3Lanes& o) const { return {x + o.x, y + o.y, z + o.z}; }
  Vec3Lanes operator*(const Lanes& s) const { return {x * s, y * s, z * s}; }
};
Vec3Lanes broadcast(const Vec3& v) { return {v.x, v.y, v.z}; }
Lanes dot(const Vec3Lanes& a, const Vec3Lanes& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

/// Henyey-Greenstein at both ends of a line without the constant factors: one root for both.
Lanes lobes_of(const Lanes& g, const Lanes& mu, const Lanes& other_g, const Lanes& other_mu) {
  const Lanes least = 1e-6f;
  const Lanes base = max(1 + g * g - 2 * g * mu, least) * max(1 + other_g * other_g - 2 * other_g * other_mu, least);
  const Lanes root = inverse_sqrt_lanes(base);
  return root * root * root;
}

Lanes rough_angle(const Lanes& c, const Lanes& sine) {
  const Lanes a = min(max(c, -c), Lanes(1.0f));
  const Lanes s = max(1 - a, Lanes(1e-12f));
  const Lanes r = s * inverse_sqrt_lanes(s) * (1.5707288f + a * (-0.2121144f + a * (0.0742610f - 0.0187293f * a)));
  return select(c > 0.95f, sine * (1 + sine * sine * (1.0f / 6)), select(c < 0, kPi - r, r));
}

Lanes exp_asinh(const Lanes& x) {
  const Lanes sum = max(x, -x) + sqrt(x * x + 1);
  return select(x < 0, 1 / sum, sum);
}

/// Turns weights into probabilities; where their sum is no number, into even ones.
void share_evenly(Strata& weights) {
  Lanes sum = 0;
  for (const Lanes& w : weights) sum += w;
  const auto good = sum > 1e-30f && sum < 1e30f;
  const Lanes scale = select(good, (1 - kEven) / sum, Lanes(0.0f));
  const Lanes even = select(good, Lanes(kEven / kStrata), Lanes(1.0f / kStrata));
  for (Lanes& w : weights) w = select(good, w * scale, Lanes(0.0f)) + even;
}

struct Coordinate {
  Lanes x, pdf;
};
Coordinate sample_strata(const Strata& probs, const Lanes& u) {
  Lanes begin = 0, index = 0, prob = probs[0];
  for (size_t j = 0; j + 1 < kStrata; ++j) {
    const Lanes end = begin + probs[j];
    const auto beyond = u >= end && index == static_cast<float>(j);
    begin = select(beyond, end, begin);
    index = select(beyond, index + 1, index);
    prob = select(beyond, probs[j + 1], prob);
  }
  const Lanes within = min((u - begin) / prob, Lanes(0x1.fffffep-1f));
  return {(index + within) * (1.0f / kStrata), prob * static_cast<float>(kStrata)};
}

/// The pairs of one vector.
class PairLanes {
 public:
  PairLanes(std::span<const PairRequest> requests, const Ray& sensor, float g_sensor)
      : count_(requests.size()), direction_(broadcast(sensor.direction)), length_(sensor.t_max), g_sensor_(g_sensor) {
    const auto gather = [&](const auto& of) {
      return Lanes([&](auto i) { return of(requests[std::min<size_t>(i, count_ - 1)]); });
    };
    start_ = Vec3Lanes{gather([](const auto& r) { return r.light->origin.x; }),
                       gather([](const auto& r) { return r.light->origin.y; }),
                       gather([](const auto& r) { return r.light->origin.z; })} -
             broadcast(sensor.origin);
    light_ = {gather([](const auto& r) { return r.light->direction.x; }),
              gather([](const auto& r) { return r.light->direction.y; }),
              gather([](const auto& r) { return r.light->direction.z; })};
    light_length_ = gather([](const auto& r) { return r.light->t_max; });
    g_light_ = gather([](const auto& r) { return r.g_light; });
    u_ = gather([](const auto& r) { return r.u.x; });
    v_ = gather([](const auto& r) { return r.u.y; });
    across_ = dot(light_, direction_);
    start_along_ = dot(start_, direction_);
    weighs_ = g_sensor != 0 || std::experimental::any_of(g_light_ != 0.0f);
  }

  void sample(std::span<SegmentPair> result) {
    choose_on_light();
    choose_on_sensor();
    for (size_t i = 0; i < count_; ++i)
      result[i] = {on_light_[i], on_sensor_[i],
                   static_cast<double>(pdf_light_[i]) * static_cast<double>(pdf_sensor_[i])};
  }

 private:
  void choose_on_light() {
    constexpr float kParallel = 1e-10f, kLeastRange = 0.05f;
    const Vec3Lanes c{light_.y * direction_.z - light_.z * direction_.y,
                      light_.z * direction_.x - light_.x * direction_.z,
                      light_.x * direction_.y - light_.y * direction_.x};
    const Lanes sine2 = dot(c, c), kept = max(sine2, Lanes(kParallel));
    const Lanes nearest = (across_ * start_along_ - dot(start_, light_)) / kept;
    const Vec3Lanes from = start_ + light_ * nearest, gap = from - direction_ * dot(from, direction_);
    const Lanes least = 1e-6f * max(light_length_, Lanes(1e-20f));
    const Lanes scale = sqrt(kept / max(dot(gap, gap), least * least));
    const Lanes begin = exp_asinh(-nearest * scale);
    const Lanes range = log_lanes(exp_asinh((light_length_ - nearest) * scale) / begin);
    const auto flat = sine2 < kParallel || !(range > kLeastRange);
    const auto place = [&](const Lanes& x) {
      const Lanes e = begin * exp_lanes(x * range);
      return select(flat, x * light_length_, nearest + 0.5f * (e - 1 / e) / scale);
    };
    Coordinate at{u_, 1.0f};
    if (weighs_) {
      Strata weights;
      const Lanes step = exp_lanes(range * (1.0f / kStrata));
      Lanes up = begin * exp_lanes(range * (0.5f / kStrata));
      for (size_t j = 0; j < kStrata; ++j) {
        const Lanes curved = nearest + 0.5f * (up - 1 / up) / scale;
        weights[j] = weight_at(select(flat, light_length_ * ((static_cast<float>(j) + 0.5f) / kStrata), curved));
        up *= step;
      }
      share_evenly(weights);
      at = sample_strata(weights, u_);
    }
    on_light_ = min(max(place(at.x), Lanes(0.0f)), light_length_);
    const Lanes along = (on_light_ - nearest) * scale;
    pdf_light_ = at.pdf * select(flat, 1 / light_length_, scale / (range * sqrt(1 + along * along)));
  }

  /// Of a stratum around t on the light's segment: the angle that the other segment subtends, times the lobes towards
  /// its ends and middle.
  Lanes weight_at(const Lanes& t) const {
    const Lanes foot = start_along_ + t * across_;
    const Vec3Lanes p = start_ + light_ * t - direction_ * foot;
    const Lanes d2 = max(dot(p, p), Lanes(1e-20f)), inverse = inverse_sqrt_lanes(d2), distance = d2 * inverse;
    const Lanes b = length_ - foot;
    const Lanes ia = inverse_sqrt_lanes(d2 + foot * foot), ib = inverse_sqrt_lanes(d2 + b * b);
    const Lanes ca = distance * ia, sa = -foot * ia, cb = distance * ib, sb = b * ib;
    const Lanes cm = ca + cb, sm = sa + sb, im = inverse_sqrt_lanes(max(cm * cm + sm * sm, Lanes(1e-12f)));
    const Lanes normal_light = -dot(p, light_) * inverse;
    const auto lobes_at = [&](const Lanes& c, const Lanes& s) {
      return lobes_of(g_sensor_, -s, g_light_, c * normal_light + s * across_);
    };
    return rough_angle(ca * cb + sa * sb, distance * length_ * ia * ib) *
           (lobes_at(ca, sa) + 2 * lobes_at(cm * im, sm * im) + lobes_at(cb, sb));
  }

  void choose_on_sensor() {
    const Vec3Lanes way = start_ + light_ * on_light_;  // from the sensor's origin to the place on the light's segment
    const Lanes foot = dot(way, direction_);
    const Vec3Lanes perpendicular = direction_ * foot - way;
    const Lanes distance = max(sqrt(dot(perpendicular, perpendicular)), Lanes(1e-6f * std::max(length_, 1e-20f)));
    const Lanes angle = angle_lanes(distance * length_, distance * distance - foot * (length_ - foot));
    Coordinate at{v_, 1.0f};
    if (weighs_) {
      const Lanes inverse = 1 / sqrt(foot * foot + distance * distance);
      const SineCosine half = sine_cosine_lanes(angle * (0.5f / kStrata));
      const Lanes cs = half.cosine * half.cosine - half.sine * half.sine, ss = 2 * half.cosine * half.sine;
      Lanes c = (distance * half.cosine + foot * half.sine) * inverse,
            s = (distance * half.sine - foot * half.cosine) * inverse;
      const Lanes normal_light = dot(perpendicular, light_) / distance;
      Strata weights;
      for (Lanes& weight : weights) {
        weight = lobes_of(g_sensor_, -s, g_light_, c * normal_light + s * across_);
        const Lanes next = c * cs - s * ss;
        s = s * cs + c * ss;
        c = next;
      }
      share_evenly(weights);
      at = sample_strata(weights, v_);
    }
    const SineCosine turn = sine_cosine_lanes(at.x * angle);
    const Lanes t = turn.sine * (foot * foot + distance * distance) / (distance * turn.cosine + foot * turn.sine);
    on_sensor_ = min(max(t, Lanes(0.0f)), Lanes(length_));
    const Lanes along = on_sensor_ - foot;
    pdf_sensor_ = at.pdf * distance / (angle * (distance * distance + along * along));
    pdf_sensor_ = select(angle > 0, pdf_sensor_, Lanes(0.0f));
  }

  size_t count_;
  Vec3Lanes direction_, start_, light_;
  float length_, g_sensor_;
  Lanes light_length_, g_light_, u_, v_, across_, start_along_;
  bool weighs_;
  Lanes on_light_, on_sensor_, pdf_light_, pdf_sensor_;
};

}  // namespace

void sample_pairs(std::span<const PairRequest> requests, const Ray& sensor, float g_sensor,
                  std::span<SegmentPair> result) {
  for (size_t i = 0; i < requests.size(); i += kLanes) {
    const size_t count = std::min(kLanes, requests.size() - i);
    PairLanes(requests.subspan(i, count), sensor, g_sensor).sample(result.subspan(i, count));
  }
}

}  // namespace turbid
