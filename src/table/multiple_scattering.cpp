#include "table/multiple_scattering.h"

#include <algorithm>
#include <cmath>

namespace turbid {
namespace {

/// Beyond it nothing is left of the light.
constexpr float kLong = 30;

/// Distances along [0, length] like the transmittance of an extinction; with none, or over a short stretch, evenly.
class Exponential {
 public:
  Exponential(float sigma_t, float length)
      : sigma_t_(sigma_t), scale_(-std::expm1(-sigma_t * std::min(length, 1e30f))), length_(length) {}
  float sample(float u) const {
    return scale_ > 1e-4f ? std::min(-std::log1p(-u * scale_) / sigma_t_, length_) : u * length_;
  }
  float pdf_t(float t) const { return scale_ > 1e-4f ? sigma_t_ * std::exp(-sigma_t_ * t) / scale_ : 1 / length_; }

 private:
  float sigma_t_, scale_, length_;
};

/// Distances like the inverse square of the distance to a point that is nearest at t = `nearest`, at `distance`
/// (Kulla & Fajardo 2012).
class Equiangular {
 public:
  Equiangular(float nearest, float distance, float length)
      : nearest_(nearest),
        distance_(distance),
        first_(std::atan(-nearest / distance)),
        range_(std::atan((length - nearest) / distance) - first_),
        length_(length) {}
  float sample(float u) const {
    return std::clamp(nearest_ + distance_ * std::tan(first_ + u * range_), 0.0f, length_);
  }
  float pdf_t(float t) const { return distance_ / (range_ * (sqr(distance_) + sqr(t - nearest_))); }

 private:
  float nearest_, distance_, first_, range_, length_;
};

}  // namespace

MultipleScattering::MultipleScattering(const HomogeneousMedium& medium, const ChannelLights& lights)
    : sigma_t_(medium.sigma_t()), mean_sigma_t_(medium.sigma_t().mean()) {
  for (int c = 0; c < kChannels; ++c) {
    Channel& channel = channels_[c];
    channel.light = lights[static_cast<size_t>(c)];
    if (!channel.light) continue;
    channel.sigma_t = sigma_t_[c];
    channel.volume_scale = channel.sigma_t * channel.sigma_t * channel.sigma_t;
    reach_ = std::max(reach_, kLong / channel.sigma_t);
  }
}

MultipleScattering::~MultipleScattering() = default;

Spectrum MultipleScattering::source_radiance(const Vec3& at, const Vec3& direction, const Vec3& x,
                                             const Vec3& w) const {
  Spectrum result;
  for (int c = 0; c < kChannels; ++c)
    if (const Channel& channel = channels_[c]; channel.light)
      result[c] = channel.volume_scale * channel.light->from_collision((x - at) * channel.sigma_t, direction, w);
  return result;
}

Spectrum MultipleScattering::source_radiance(const Stretch& light, const Vec3& x, const Vec3& w) const {
  Spectrum result;
  for (int c = 0; c < kChannels; ++c) {
    const Channel& channel = channels_[c];
    const float depth = light.length * channel.sigma_t;
    if (!channel.light || !(depth > 0)) continue;
    const Vec3 from = (x - light.origin) * channel.sigma_t;
    result[c] = channel.volume_scale * std::max(0.0f, channel.light->from_stretch(from, light.direction, depth, w));
  }
  return result;
}

Spectrum MultipleScattering::source_radiance(std::span<const WeightedStretch> lights, const Vec3& x,
                                             const Vec3& w) const {
  if (lights.size() == 1 && lights[0].weight == 1) return source_radiance(lights[0].stretch, x, w);
  Spectrum sum(0.0f);
  for (const WeightedStretch& light : lights) sum += source_radiance(light.stretch, x, w) * light.weight;
  for (int c = 0; c < kChannels; ++c) sum[c] = std::max(sum[c], 0.0f);
  return sum;
}

MultipleScattering::LaneSpectrum MultipleScattering::from_collision(const Vec3& at, const Vec3& direction,
                                                                    const Vec3Lanes& x, const Vec3& w) const {
  LaneSpectrum result;
  for (size_t c = 0; c < kChannels; ++c) {
    const Channel& channel = channels_[c];
    const Vec3Lanes from = (x - lanes_of(at)) * Lanes(channel.sigma_t);
    result[c] = channel.light ? channel.volume_scale * channel.light->from_collision(from, direction, w) : Lanes(0.0f);
  }
  return result;
}

MultipleScattering::LaneSpectrum MultipleScattering::from_stretches(std::span<const WeightedStretch> lights,
                                                                    const Vec3Lanes& x, const Vec3& w) const {
  LaneSpectrum result;
  for (size_t c = 0; c < kChannels; ++c) {
    const Channel& channel = channels_[c];
    Lanes sum(0.0f);
    for (const auto& [light, weight] : lights) {
      const float depth = light.length * channel.sigma_t;
      if (!channel.light || !(depth > 0)) continue;
      const Vec3Lanes from = (x - lanes_of(light.origin)) * Lanes(channel.sigma_t);
      const Lanes value = channel.light->from_stretch(from, light.direction, depth, w);
      sum += weight * std::experimental::max(value, Lanes(0.0f));
    }
    result[c] = channel.volume_scale * std::experimental::max(sum, Lanes(0.0f));
  }
  return result;
}

template <class Source>
Spectrum MultipleScattering::integrate(const Stretch& view, float nearest, float distance, float u, int samples,
                                       const Source& source) const {
  const float length = std::min(view.length, reach_);
  if (!(length > 0)) return Spectrum();
  const Exponential by_transmittance(mean_sigma_t_, length);
  const Equiangular by_distance(std::clamp(nearest, 0.0f, length), std::max(distance, 1e-3f / mean_sigma_t_), length);
  LaneSpectrum sum;
  sum.fill(Lanes(0.0f));
  const size_t points = 2 * static_cast<size_t>(samples);
  for (size_t first = 0; first < points; first += kLanes) {
    LaneRow depths{}, weights{};
    for (size_t lane = 0; lane < std::min(kLanes, points - first); ++lane) {
      const size_t point = first + lane;
      const float stratum = (static_cast<float>(point / 2) + u) / static_cast<float>(samples);
      const float t = depths[lane] = point % 2 == 0 ? by_transmittance.sample(stratum) : by_distance.sample(stratum);
      // Balance heuristic over both ways of placing points.
      weights[lane] = 1 / (by_transmittance.pdf_t(t) + by_distance.pdf_t(t));
    }
    const Lanes t = load_lanes(depths), weight = load_lanes(weights);
    const LaneSpectrum light = source(lanes_of(view.origin) + lanes_of(view.direction) * t, -view.direction);
    for (size_t c = 0; c < kChannels; ++c) sum[c] += exp_lanes(channels_[c].sigma_t * -t) * light[c] * weight;
  }
  Spectrum result;
  for (size_t c = 0; c < kChannels; ++c)
    result[static_cast<int>(c)] = std::experimental::reduce(sum[c]) / static_cast<float>(samples);
  return result;
}

Spectrum MultipleScattering::radiance(const Vec3& at, const Vec3& direction, const Stretch& view, float u,
                                      int samples) const {
  const float nearest = dot(at - view.origin, view.direction);
  const float distance = length(at - view.origin - view.direction * nearest);
  return integrate(view, nearest, distance, u, samples,
                   [&](const Vec3Lanes& x, const Vec3& w) { return from_collision(at, direction, x, w); });
}

Spectrum MultipleScattering::radiance(std::span<const WeightedStretch> lights, const Stretch& view, float u,
                                      int samples) const {
  const Stretch& light = lights.front().stretch;
  // The nearest points of both lines; on the light's stretch within the mean free path that most of it collides in.
  const Vec3 between = light.origin - view.origin;
  const float cosine = dot(light.direction, view.direction);
  const float sine_squared = std::max(1e-6f, 1 - cosine * cosine);
  const float on_light =
      std::clamp((cosine * dot(between, view.direction) - dot(between, light.direction)) / sine_squared, 0.0f,
                 std::min(light.length, 2 / mean_sigma_t_));
  const Vec3 at = light.origin + light.direction * on_light;
  const float nearest = dot(at - view.origin, view.direction);
  const float distance = length(at - view.origin - view.direction * nearest);
  return integrate(view, nearest, distance, u, samples,
                   [&](const Vec3Lanes& x, const Vec3& w) { return from_stretches(lights, x, w); });
}

}  // namespace turbid
