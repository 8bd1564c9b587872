#include "integrator/walked_scattering.h"

#include "core/warp.h"
#include "manylight/volume_points.h"
#include "path/once_more.h"

namespace turbid {
namespace {

/// A collision of the walk, its albedo in the throughput.
struct Reached {
  Vec3 position, direction;  ///< into it
  Spectrum throughput;
};

/// From there by one inserted collision to x, where light leaves towards w.
Spectrum insert(const HomogeneousMedium& medium, const Reached& from, const Vec3& x, const Vec3& w, Rng& rng) {
  const PhaseFunction& phase = medium.phase();
  const float u_theta = rng.next_float(), u_beta = rng.next_float(), u_phi = rng.next_float();
  const auto inserted = insert_collision(phase, from.position, {x}, Insertion::kAngle, u_theta, u_beta, u_phi);
  if (!inserted) return Spectrum(0.0f);
  const double geometry =
      static_cast<double>(inserted->f) /
      (sqr(static_cast<double>(inserted->d1) * static_cast<double>(inserted->d2)) * inserted->pdf_v);
  const float lobes = phase.eval(dot(from.direction, inserted->arrives)) * phase.eval(dot(inserted->leaves, w));
  return from.throughput * medium.transmittance(inserted->d1 + inserted->d2) * medium.sigma_s() * medium.sigma_s() *
         (lobes * static_cast<float>(geometry));
}

}  // namespace

Spectrum walk_source_radiance(const HomogeneousMedium& medium, int from_order, const Stretch& light, const Vec3& x,
                              const Vec3& w, Rng& rng) {
  constexpr float kLongest = 40;  // mean free paths: further along nothing sets out any more
  const float length = std::min(light.length, kLongest / medium.sigma_t().min());
  const MadeDistance first = collide_before(medium, length, Spectrum(1.0f / kChannels), rng.next_float());
  if (!std::isfinite(first.t) || !(first.pdf_t > 0)) return Spectrum(0.0f);
  Reached at{light.origin + light.direction * first.t, light.direction,
             medium.transmittance(first.t) * medium.sigma_s() / first.pdf_t};
  const float start = at.throughput.max();
  Spectrum sum(0.0f);
  for (int collisions = 1; at.throughput.max() > 0; ++collisions) {
    if (collisions + 2 >= from_order) sum += insert(medium, at, x, w, rng);
    const float survival = std::min(1.0f, at.throughput.max() / start);
    if (rng.next_float() >= survival) break;
    at.throughput /= survival;
    const float mu = medium.phase().sample(rng.next_float());
    at.direction = direction_about(at.direction, mu, 2 * kPi * rng.next_float());
    const Flight flight = medium.flight(kInfinity, channel_mix(at.throughput), rng.next_float());
    at.position += at.direction * flight.t;
    at.throughput *= flight.weight;
  }
  return sum;
}

}  // namespace turbid
