// Full pictures of virtual lights, nothing clamped or left out: 1/distance^2 has a mean, but no variance, so that no
// z-test holds. Medians of means do: the mean of each of many groups of samples, and the order of these.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <numeric>

#include "integrator/agreement.h"
#include "integrator/suite.h"

namespace turbid::testing {
namespace {

constexpr int kBlock = 8;
constexpr uint32_t kGroups = 31;
/// The median of what the groups' means come from lies between the so-many-th smallest and largest of 31 of them but
/// for one time in 3000 (binomial distribution).
constexpr size_t kRank = 6;

/// Means over blocks of pixels and channels, the whole picture last.
std::vector<double> block_means(const Film& film) {
  const Vec2i size = film.size();
  const int columns = (size.x + kBlock - 1) / kBlock, rows = (size.y + kBlock - 1) / kBlock;
  std::vector<double> sums(static_cast<size_t>(columns * rows) + 1), counts(sums.size());
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) {
      const PixelSums& pixel = film.pixel(static_cast<size_t>(y * size.x + x));
      const double grey = std::accumulate(std::begin(pixel.radiance), std::end(pixel.radiance), 0.0) / kChannels;
      for (const size_t block : {static_cast<size_t>(y / kBlock * columns + x / kBlock), sums.size() - 1}) {
        sums[block] += grey / static_cast<double>(film.samples());
        ++counts[block];
      }
    }
  for (size_t block = 0; block < sums.size(); ++block) sums[block] /= counts[block];
  return sums;
}

/// Of each block the means of the groups, in ascending order.
std::vector<std::vector<double>> groups_of(const std::string& xml, const std::string& integrator, uint32_t samples) {
  std::vector<std::vector<double>> blocks;
  for (uint32_t group = 0; group < kGroups; ++group) {
    const auto means = block_means(render_samples(xml, integrator, samples, 2, group * samples));
    blocks.resize(means.size());
    for (size_t block = 0; block < means.size(); ++block) blocks[block].push_back(means[block]);
  }
  for (auto& means : blocks) std::sort(means.begin(), means.end());
  return blocks;
}

struct Verdict {
  bool agrees = true;
  double width = 0;  ///< of the interval for the whole picture, over its mean
  std::string report;
};

/// `brightness`: other than 1, a planted error.
Verdict compare_medians(const std::string& scene, const std::string& integrator, uint32_t samples,
                        double brightness = 1) {
  const std::string& xml = suite_scene(scene).xml;
  const auto reference = groups_of(xml, "volpath", 16 * samples), seen = groups_of(xml, integrator, samples);
  Verdict verdict;
  for (size_t block = 0; block < seen.size(); ++block) {
    double mean = 0, squares = 0;
    for (const double value : reference[block]) mean += value / kGroups, squares += value * value / kGroups;
    const double error = std::sqrt(std::max(0.0, squares - mean * mean) / (kGroups - 1));
    const double low = brightness * seen[block][kRank - 1], high = brightness * seen[block][kGroups - kRank];
    verdict.agrees &= mean > low - 3 * error && mean < high + 3 * error;
    verdict.width = (high - low) / mean;
    verdict.report += fmt::format("block {}: {:.5f} +- {:.5f}, median of means {:.5f} in [{:.5f}, {:.5f}]\n", block,
                                  mean, error, brightness * seen[block][kGroups / 2], low, high);
  }
  return verdict;
}

void expect_volpath(const std::string& scene, const std::string& integrator, uint32_t samples) {
  const Verdict verdict = compare_medians(scene, integrator, samples);
  EXPECT_TRUE(verdict.agrees) << scene << ", " << integrator << "\n" << verdict.report;
  EXPECT_LT(verdict.width, 0.1) << scene << ", " << integrator << ": says little\n" << verdict.report;
}

TEST(MediansOfMeans, FullPicturesAreThoseOfVolpath) {
  expect_volpath("lamp in fog, any length", "vpl,light_sampler=all,lights=60,volume_points=2,reuse=1", 8);
}

TEST(MediansOfMeans, NoticeAnError) {
  EXPECT_FALSE(
      compare_medians("lamp in fog, any length", "vpl,light_sampler=all,lights=60,volume_points=2,reuse=1", 8, 1.1)
          .agrees);
}

// Not "small lamp in fog": the lamp itself, seen in a few pixels by chance, makes all the noise there.
class MediansOfMeansEverywhere : public ::testing::TestWithParam<const char*> {};

TEST_P(MediansOfMeansEverywhere, FullPicturesAreThoseOfVolpath) {
  const SuiteScene& scene = suite_scene(GetParam());
  for (const char* how : {"vpl,light_sampler=importance_cache,surface_caches=50,volume_caches=50,light_samples=16",
                          "vrl,light_sampler=all"})
    expect_volpath(scene.name, std::string(how) + ",lights=100,volume_points=2,reuse=2", 48 * scene.effort);
}

INSTANTIATE_TEST_SUITE_P(SlowScenes, MediansOfMeansEverywhere,
                         ::testing::Values("lamp in fog, any length", "spot in fog", "sky on fog", "sun on fog",
                                           "chromatic medium", "heterogeneous medium", "several media in turn",
                                           "caustic into fog", "sensor inside the medium"),
                         [](const auto& instance) { return test_name(instance.param); });

}  // namespace
}  // namespace turbid::testing
