#include <benchmark/benchmark.h>

#include "core/sampler.h"
#include "medium/henyey_greenstein.h"
#include "medium/homogeneous.h"
#include "medium/isotropic.h"
#include "medium/rayleigh.h"

/// What a collision costs beside its rays, of one thread: random numbers, a deflection, a free flight.
namespace turbid {
namespace {

constexpr int kBatch = 4096;

void report_items(benchmark::State& state) { state.SetItemsProcessed(state.iterations() * kBatch); }

void random_numbers(benchmark::State& state, SamplerKind kind) {
  Sampler sampler(kind, 1);
  uint64_t index = 0;
  for (auto _ : state) {
    for (int i = 0; i < kBatch; ++i) {
      if (i % 16 == 0) sampler.start(3, index++);
      benchmark::DoNotOptimize(sampler.next_1d());
    }
  }
  report_items(state);
}
BENCHMARK_CAPTURE(random_numbers, independent, SamplerKind::kIndependent);
BENCHMARK_CAPTURE(random_numbers, sobol, SamplerKind::kSobol);

/// Through the virtual interface, as a path does it.
void sample_phase(benchmark::State& state, const PhaseFunction& phase) {
  Rng rng(1);
  const PhaseFunction* hidden = &phase;
  benchmark::DoNotOptimize(hidden);
  for (auto _ : state)
    for (int i = 0; i < kBatch; ++i) benchmark::DoNotOptimize(hidden->sample(rng.next_float()));
  report_items(state);
}
BENCHMARK_CAPTURE(sample_phase, isotropic, IsotropicPhase());
BENCHMARK_CAPTURE(sample_phase, henyey_greenstein, HenyeyGreensteinPhase(0.8f));
BENCHMARK_CAPTURE(sample_phase, rayleigh, RayleighPhase());

void eval_phase(benchmark::State& state, const PhaseFunction& phase) {
  Rng rng(1);
  const PhaseFunction* hidden = &phase;
  benchmark::DoNotOptimize(hidden);
  for (auto _ : state)
    for (int i = 0; i < kBatch; ++i) benchmark::DoNotOptimize(hidden->eval(2 * rng.next_float() - 1));
  report_items(state);
}
BENCHMARK_CAPTURE(eval_phase, henyey_greenstein, HenyeyGreensteinPhase(0.8f));

void sample_distance(benchmark::State& state, const Spectrum& sigma_t) {
  const HomogeneousMedium homogeneous(sigma_t, sigma_t * 0.9f, std::make_shared<IsotropicPhase>());
  const Medium* medium = &homogeneous;
  benchmark::DoNotOptimize(medium);
  Sampler sampler(SamplerKind::kIndependent, 1);
  sampler.start(0, 0);
  const Ray ray{{0, 0, 0}, {0, 0, 1}, 1};
  const Spectrum mix(0.5f, 0.3f, 0.2f);
  for (auto _ : state)
    for (int i = 0; i < kBatch; ++i) benchmark::DoNotOptimize(medium->sample_flight(ray, mix, sampler));
  report_items(state);
}
BENCHMARK_CAPTURE(sample_distance, grey, Spectrum(2.0f));
BENCHMARK_CAPTURE(sample_distance, chromatic, Spectrum(2.0f, 1.0f, 4.0f));

}  // namespace
}  // namespace turbid
