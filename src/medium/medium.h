#pragma once
#include <memory>

#include "core/ray.h"
#include "core/sampler.h"
#include "core/spectrum.h"
#include "medium/phase_function.h"

namespace turbid {

/// A free flight drawn by Medium::sample_flight.
struct Flight {
  bool collides = false;  ///< false: the flight reaches t_max (or leaves the medium's support)
  float t = 0;            ///< distance of the collision
  Spectrum weight;        ///< collision: sigma_s T(t) / pdf_t; passed: T(t_max) / prob. Multiplies the throughput.
  /// Passed: sum over channels of mix x proxy_transmittance. For homogeneous media it is the probability of passing.
  float probability = 1;
  Spectrum emission{0.0f};  ///< estimate of what the medium itself adds along the flight; times the throughput before
};

class HomogeneousMedium;

/// What fills a volume. Lengths are scene units, sigma in 1/unit. Immutable, shared between threads.
class Medium {
 public:
  explicit Medium(std::shared_ptr<const PhaseFunction> phase) : phase_(std::move(phase)) {}
  virtual ~Medium() = default;

  const PhaseFunction& phase() const { return *phase_; }

  /// Draws a free flight along the ray up to ray.t_max (may be infinite). Its distance is drawn from the mixture of the
  /// channels' densities with weights `mix` (non-negative, sum 1) and the weight divides by that whole mixture, so that
  /// no channel is ever divided by the density of another alone (NUMERICS 0).
  virtual Flight sample_flight(const Ray& ray, const Spectrum& mix, Sampler& sampler) const = 0;

  /// Transmittance over the whole ray (exact, or an unbiased estimate), per channel. Random numbers come from
  /// Sampler::aside.
  virtual Spectrum transmittance(const Ray& ray, const Sampler& sampler) const = 0;

  /// A stand-in for the transmittance that depends on the ray alone and is not 0 where light comes through. Multiple
  /// importance sampling across media weighs by it, the same for all techniques (NUMERICS 3). Exact for homogeneous
  /// media.
  virtual Spectrum proxy_transmittance(const Ray& ray) const = 0;

  /// The scattering coefficient at p, 1/unit.
  virtual Spectrum sigma_s_at(const Vec3& /*p*/) const { return sigma_s(); }

  /// A stand-in for the extinction at p, with the same purpose: not 0 where light collides.
  virtual Spectrum proxy_sigma_t(const Vec3& /*p*/) const { return sigma_t(); }

  /// Whether flights can bring emission.
  virtual bool emits() const { return false; }

  /// Largest extinction of any channel anywhere: 1/max_sigma_t is the shortest mean free path.
  virtual float max_sigma_t() const = 0;
  /// This medium when it is the same everywhere, so that sigma_t and sigma_s below hold for all of it; else null.
  virtual const HomogeneousMedium* as_homogeneous() const { return nullptr; }
  /// Representative (for homogeneous media: exact) extinction and scattering coefficients, 1/unit.
  virtual Spectrum sigma_t() const = 0;
  virtual Spectrum sigma_s() const = 0;

 private:
  std::shared_ptr<const PhaseFunction> phase_;
};

}  // namespace turbid
