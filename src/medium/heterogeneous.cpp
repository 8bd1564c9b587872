#include "medium/heterogeneous.h"

#include <stdexcept>

#include "core/parallel.h"

namespace turbid {
namespace {

const Volume& required(const std::shared_ptr<const Volume>& volume, const char* what) {
  if (!volume) throw std::invalid_argument(std::string("a heterogeneous medium needs a volume for its ") + what);
  return *volume;
}

void check(const Volume& volume, const char* what, float scale, float max = std::numeric_limits<float>::max()) {
  const ValueRange range = volume.range(volume.bounds());
  if (!(scale >= 0) || !std::isfinite(scale))
    throw std::invalid_argument(std::string("the scale of ") + what + " must be finite and not negative");
  if (!(range.min.min() >= 0)) throw std::invalid_argument(std::string(what) + " must not be negative anywhere");
  if (!(range.max.max() * scale <= max))
    throw std::invalid_argument(std::string(what) + (max == 1 ? " must not exceed 1 anywhere" : " must be finite"));
}

/// Cells of the majorant grid along each axis: a few steps of the data per cell, where a ray crosses them about as
/// often as it looks up the data.
std::array<int, 3> cell_counts(const Volume& sigma_t, const Volume* emission) {
  constexpr float kStepsPerCell = 4;
  constexpr int kMostCells = 128;
  std::array<int, 3> counts{};
  for (unsigned a = 0; a < 3; ++a) {
    float steps = sigma_t.resolution()[a];
    if (steps < 2 && emission) steps = emission->resolution()[a];
    counts[a] = std::clamp(static_cast<int>(std::ceil(steps / kStepsPerCell)), 1, kMostCells);
  }
  return counts;
}

MajorantGrid make_grid(const HeterogeneousParts& parts) {
  const Volume& sigma_t = required(parts.sigma_t, "extinction");
  return {sigma_t.bounds(), cell_counts(sigma_t, parts.emission.get())};
}

/// Positive exponential variate from u in [0, 1).
float optical_distance(float u) { return -std::log(1 - u); }

/// Share of each channel that a null collision leaves. Rounding may push the extinction past its bound.
Spectrum null_share(const Spectrum& real) {
  return {std::max(0.0f, 1 - real[0]), std::max(0.0f, 1 - real[1]), std::max(0.0f, 1 - real[2])};
}

/// Only the ratio of the two counts: keeps them above the smallest floats on a long way.
void rescale(Spectrum& passed, Spectrum& mixture) {
  constexpr float kSmall = 1e-20f;
  if (mixture.sum() > kSmall) return;
  mixture /= kSmall;
  // Channels that the mixture has lost (mix = 0) could go on growing for ever.
  for (int c = 0; c < kChannels; ++c) passed[c] = std::min(passed[c] / kSmall, 1 / kSmall);
}

/// exp(-depth), but the proxy says of no passage that it is closed.
Spectrum proxy(const Spectrum& depth) {
  constexpr float kDeepest = 30;
  Spectrum result;
  for (int c = 0; c < kChannels; ++c) result[c] = std::exp(-std::min(depth[c], kDeepest));
  return result;
}

}  // namespace

HeterogeneousMedium::HeterogeneousMedium(const HeterogeneousParts& parts)
    : Medium(parts.phase), parts_(parts), grid_(make_grid(parts)) {
  if (!parts.phase) throw std::invalid_argument("a heterogeneous medium needs a phase function");
  check(*parts.sigma_t, "sigma_t", parts.scale);
  check(required(parts.albedo, "albedo"), "albedo", 1, 1);
  if (parts.emission) check(*parts.emission, "emission", parts.emission_scale);
  fill_grid();
  for (const int c : {0, 1, 2})
    max_sigma_t_ = std::max(max_sigma_t_, parts.scale * parts.sigma_t->range(bounds()).max[c]);
  mean_sigma_t_ = parts.sigma_t->range(bounds()).mean * parts.scale;
  mean_sigma_s_ = mean_sigma_t_ * parts.albedo->range(bounds()).mean;
}

void HeterogeneousMedium::fill_grid() {
  // Where the medium shines there must be tentative collisions even if it is almost clear: so many per diagonal.
  constexpr float kSamplesPerDiagonal = 8;
  const float least_where_bright = kSamplesPerDiagonal / length(bounds().max - bounds().min);
  const std::array<int, 3> counts = grid_.cell_counts();
  parallel_for(static_cast<size_t>(counts[2]), [&](size_t layer) {
    const int z = static_cast<int>(layer);
    for (int y = 0; y < counts[1]; ++y)
      for (int x = 0; x < counts[0]; ++x) {
        const Bounds3 box = grid_.cell_box(x, y, z);
        const ValueRange range = parts_.sigma_t->range(box);
        MajorantCell& cell = grid_.cell(x, y, z);
        cell.majorant = range.max.max() * parts_.scale;
        cell.minorant = range.min * parts_.scale;
        cell.mean = range.mean * parts_.scale;
        const bool shines = parts_.emission && parts_.emission_scale > 0 &&
                            !(parts_.emission_by_absorption && cell.majorant == 0) &&
                            parts_.emission->range(box).max.max() > 0;
        if (shines) cell.majorant = std::max(cell.majorant, least_where_bright);
      }
  });
}

Spectrum HeterogeneousMedium::emission(const Vec3& p, const Spectrum& extinction) const {
  const Spectrum value = parts_.emission->eval(p) * parts_.emission_scale;
  return parts_.emission_by_absorption ? value * extinction * (Spectrum(1.0f) - parts_.albedo->eval(p)) : value;
}

Flight HeterogeneousMedium::sample_flight(const Ray& ray, const Spectrum& mix, Sampler& sampler) const {
  Flight flight;
  Spectrum passed(1.0f);                              // prod n_i
  Spectrum mixture = mix;                             // N_i
  Spectrum depth(0.0f);                               // for the proxy
  float ahead = optical_distance(sampler.next_1d());  // in majorants, to the next tentative collision
  grid_.walk(ray, [&](const MajorantCell& cell, float t, float end) {
    depth += cell.mean * (end - t);
    while (true) {
      if (ahead >= cell.majorant * (end - t)) {
        ahead -= cell.majorant * (end - t);
        return true;
      }
      t += ahead / cell.majorant;
      const Vec3 p = ray.at(t);
      const Spectrum sigma_t = extinction(p);
      if (parts_.emission) flight.emission += passed / mixture.sum() * emission(p, sigma_t) / cell.majorant;
      const Spectrum real = sigma_t / cell.majorant;
      const float real_share = (mixture * real).sum();
      if (sampler.next_1d() * mixture.sum() < real_share) {
        flight.collides = true;
        flight.t = t;
        flight.weight = passed * real * parts_.albedo->eval(p) / real_share;
        return false;
      }
      const Spectrum null = null_share(real);
      passed *= null;
      mixture *= null;
      rescale(passed, mixture);
      ahead = optical_distance(sampler.next_1d());
    }
  });
  if (flight.collides) return flight;
  flight.weight = passed / mixture.sum();
  flight.probability = (mix * proxy(depth)).sum();
  return flight;
}

Spectrum HeterogeneousMedium::transmittance(const Ray& ray, const Sampler& sampler) const {
  Rng rng = sampler.aside(Purpose::kAttenuation, ray.origin, ray.direction);
  Spectrum estimate(1.0f);                 // of what exceeds the minorants
  constexpr float kRouletteBelow = 0.01f;  // what is left may end at random
  Spectrum control(0.0f);                  // optical depth of the minorants
  float ahead = optical_distance(rng.next_float());
  grid_.walk(ray, [&](const MajorantCell& cell, float t, float end) {
    control += cell.minorant * (end - t);
    const float majorant = cell.majorant - cell.minorant.min();
    while (true) {
      if (!(ahead < majorant * (end - t))) {
        ahead -= majorant * (end - t);
        return true;
      }
      t += ahead / majorant;
      estimate *= null_share((extinction(ray.at(t)) - cell.minorant) / majorant);
      if (estimate.is_black()) return false;
      if (estimate.max() < kRouletteBelow) {
        if (rng.next_float() < 0.5f) {
          estimate = Spectrum(0.0f);
          return false;
        }
        estimate *= 2.0f;
      }
      ahead = optical_distance(rng.next_float());
    }
  });
  return estimate * exp(control * -1.0f);
}

Spectrum HeterogeneousMedium::sigma_s_at(const Vec3& p) const {
  return bounds().intersects(p) ? extinction(p) * parts_.albedo->eval(p) : Spectrum(0.0f);
}

Spectrum HeterogeneousMedium::proxy_sigma_t(const Vec3& p) const {
  constexpr float kLeastShare = 1e-3f;
  const MajorantCell& cell = grid_.cell_at(p);
  Spectrum result;
  for (int c = 0; c < kChannels; ++c) result[c] = std::max(cell.mean[c], kLeastShare * cell.majorant);
  return result;
}

Spectrum HeterogeneousMedium::proxy_transmittance(const Ray& ray) const {
  Spectrum depth(0.0f);
  grid_.walk(ray, [&](const MajorantCell& cell, float t, float end) {
    depth += cell.mean * (end - t);
    return true;
  });
  return proxy(depth);
}

}  // namespace turbid
