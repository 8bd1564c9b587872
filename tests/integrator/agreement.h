#pragma once
#include <array>
#include <optional>

#include "image/z_test.h"
#include "integrator/rendering.h"

namespace turbid::testing {

/// Two-estimator z-tests between integrators over passes, in blocks of pixels (NUMERICS 10): for the whole picture and
/// for each class of scattering order.

inline constexpr uint32_t kPasses = 32;

/// An integrator as it is named on the command line ("bdpt,heuristic=balance"), and its samples per pass.
struct Contestant {
  std::string integrator;
  uint32_t samples = 32;
  double brightness = 1;  ///< other than 1: a planted error
  uint64_t seed = 1;
};

/// The integrator that `words` name (as on the command line), in the place of the scene's.
IntegratorSetup make_named(const std::string& words, const LoadedScene& loaded);
/// The samples [first, first + count) of every pixel by `integrator` (as on the command line), with so many threads.
Film render_samples(const std::string& xml, const std::string& integrator, uint32_t count, int threads = 2,
                    uint32_t first = 0);
/// Asserts that the pictures are the same bits.
void expect_same(const Film& a, const Film& b);

/// What one contestant saw.
struct Observation {
  PassStatistics all;
  std::array<PassStatistics, kOrderClasses> orders;
  std::vector<bool> specular_blocks;  ///< blocks in which the sensor looks straight at a specular surface
  PathSupport support;
};

/// Renders kPasses passes; statistics are over blocks of `block` x `block` pixels. Dropped samples and saturated splats
/// are failures.
Observation observe(const std::string& xml, const Contestant& contestant, int block = 4);
/// The same of an integrator at hand; the contestant's name is not looked at.
Observation observe(const Scene& scene, Integrator& integrator, const Contestant& contestant, int block = 4);

/// The comparison of two observations: one verdict for all light (index 0) and for each class of order (1 + class);
/// empty where neither saw anything. `cannot`: why nothing can be compared.
struct Agreement {
  std::string cannot;
  size_t blocks = 0;  ///< compared; the others show what one of the two cannot sample
  std::array<std::optional<ZTestResult>, 1 + kOrderClasses> verdicts;
  std::array<double, 1 + kOrderClasses> mean_ratio{};   ///< second over first
  std::array<double, 1 + kOrderClasses> ratio_error{};  ///< its standard error

  /// No test rejects, all of them together at level 0.01 (Sidak's correction): those of the blocks, those of the means,
  /// and those of `comparisons - 1` other comparisons like this one.
  bool accepted(size_t comparisons = 1) const { return accepted(smallest_p(), true, comparisons); }
  /// The same without those of the blocks, where light is too rare in single blocks.
  bool means_accepted(size_t comparisons = 1) const { return accepted(smallest_p_of_means(), false, comparisons); }
  /// The smallest p-value of any test; of the means.
  double smallest_p() const;
  double smallest_p_of_means() const;
  std::string report() const;

 private:
  bool accepted(double p, bool with_blocks, size_t comparisons) const;
};
Agreement compare(const Observation& first, const Observation& second);

/// Asserts that two integrators agree on a scene, and that the comparison says something.
void expect_agreement(const std::string& xml, const Contestant& first, const Contestant& second,
                      double largest_error = 0.05, int block = 4);

}  // namespace turbid::testing
