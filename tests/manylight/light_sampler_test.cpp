// Choosing among virtual lights: every way returns lights as often as it says, and finds all that bring something.
#include "manylight/light_sampler.h"

#include <gtest/gtest.h>

#include "manylight/importance_cache.h"
#include "manylight/light_tree.h"
#include "manylight/lights_for_tests.h"
#include "testing/chi_square.h"

namespace turbid::testing {
namespace {

FoggyBox& box() {
  static FoggyBox box;
  return box;
}

/// A cache whose records are what lights would bring without shadows, where `dark` says so none.
std::unique_ptr<LightSampler> make_cache(const VirtualLights& places, const CacheShares& shares, size_t dark = 1000) {
  CacheSettings settings;
  settings.shares = shares;
  settings.points = {places.size(), places.size(), 0};
  return std::make_unique<ImportanceCache>(
      settings, box().lights.size(), std::array{0.1f, 0.0f, 0.0f},
      [&, dark](PlaceKind kind, size_t number, std::span<float> weights) {
        const Scatterer& place = places.points()[number % places.size()];
        if (place.is_surface() != (kind == PlaceKind::kSurface)) return ImportanceCache::Record{};
        for (size_t i = 0; i < weights.size(); ++i)
          weights[i] = number % dark == dark - 1 ? 0 : unshadowed(place, box().lights.points()[i], {}).mean();
        return ImportanceCache::Record{place.position(), place.is_surface() ? place.normal() : Vec3(0), true};
      },
      std::make_unique<NearLights>(box().lights, LineSettings{}));
}

struct NamedSampler {
  std::string name;
  std::unique_ptr<LightSampler> sampler;
};
std::vector<NamedSampler> samplers(const VirtualLights& cached) {
  std::vector<NamedSampler> all;
  const VirtualLights& lights = box().lights;
  all.push_back({"uniform", std::make_unique<UniformLightSampler>(lights.size())});
  all.push_back({"power", std::make_unique<PowerLightSampler>(lights)});
  all.push_back({"lfg", std::make_unique<UnshadowedLightSampler>(lights, LineSettings{})});
  all.push_back({"light tree", std::make_unique<LightTree>(lights, LineSettings{})});
  all.push_back({"light tree, clamped", std::make_unique<LightTree>(lights, LineSettings{.clamp_distance = 1})});
  all.push_back({"cache", make_cache(cached, CacheShares{})});
  all.push_back({"cache with dark points", make_cache(cached, CacheShares{}, 2)});
  all.push_back({"cache as in the seed", make_cache(cached, CacheShares::seed(3), 2)});
  return all;
}

/// The test of one sampler at one place; `wrong` spoils the probabilities.
ChiSquareResult test_choice(LightSampler::Chooser& chooser, size_t lights, double wrong = 0) {
  const auto n = static_cast<double>(lights);
  ChiSquareSettings settings;
  settings.interval_bins = static_cast<int>(lights);
  return chi_square_interval(
      [&](Rng& rng) -> std::optional<double> {
        const auto choice = chooser.sample(rng.next_double());
        if (!choice) return std::nullopt;
        return (static_cast<double>(choice->light) + 0.5) / n;
      },
      [&](double x) {
        const auto light = std::min(static_cast<size_t>(x * n), lights - 1);
        return n * chooser.prob(light) * (1 + (light % 2 ? wrong : -wrong));
      },
      0, 1, settings);
}

TEST(LightSamplers, ChooseAsOftenAsTheySay) {
  const VirtualLights cached = box().places(),
                      places({box().scene, box().sources, box().settings, 9}, 3, 2, box().counters);
  const size_t lights = box().lights.size();
  ASSERT_GT(lights, 100u);
  const auto all = samplers(cached);
  const size_t tests = all.size() * places.size();
  for (const auto& [name, sampler] : all) {
    const auto chooser = sampler->make_chooser();
    bool noticed = false;
    for (const Scatterer& place : places.points()) {
      chooser->move_to(place);
      const ChiSquareResult result = test_choice(*chooser, lights);
      EXPECT_TRUE(passes(result, static_cast<int>(tests))) << name << ": " << result.report;
      noticed |= !passes(test_choice(*chooser, lights, 0.1), static_cast<int>(tests));
    }
    EXPECT_TRUE(noticed) << name << ": an error of a tenth";
  }
}

TEST(LightSamplers, SayTheSameOfWhatTheyDraw) {
  const VirtualLights cached = box().places();
  for (const auto& [name, sampler] : samplers(cached)) {
    const auto chooser = sampler->make_chooser();
    Rng rng(3);
    for (const Scatterer& place : cached.points()) {
      chooser->move_to(place);
      double sum = 0;
      for (size_t light = 0; light < box().lights.size(); ++light) sum += chooser->prob(light);
      EXPECT_NEAR(sum, 1, 1e-9) << name;
      for (int i = 0; i < 20; ++i) {
        const auto choice = chooser->sample(rng.next_double());
        ASSERT_TRUE(choice) << name;
        EXPECT_NEAR(choice->prob, chooser->prob(choice->light), 1e-9 * choice->prob) << name;
      }
    }
  }
}

TEST(LightSamplers, FindEveryLightThatBringsSomething) {
  const VirtualLights cached = box().places();
  for (const auto& [name, sampler] : samplers(cached)) {
    const auto chooser = sampler->make_chooser();
    for (const Scatterer& place : cached.points()) {
      chooser->move_to(place);
      for (size_t light = 0; light < box().lights.size(); ++light)
        EXPECT_TRUE(unshadowed(place, box().lights.points()[light], {}).is_black() || chooser->prob(light) > 0) << name;
    }
  }
}

// --- the store of caches -------------------------------------------------------------------------------------------

TEST(CompactDistributions, KeepWeightsWithinTheirStep) {
  Rng rng(1);
  std::vector<float> weights(1000);
  for (float& weight : weights) weight = std::exp2(-30 * rng.next_float());
  weights[17] = 0;
  CompactDistributions rows(3, weights.size());
  rows.set(1, weights);
  EXPECT_TRUE(rows.is_empty(0));
  EXPECT_FALSE(rows.is_empty(1));
  const float largest = *std::max_element(weights.begin(), weights.end());
  const double unit =
      rows.prob(1, static_cast<size_t>(std::max_element(weights.begin(), weights.end()) - weights.begin()));
  double sum = 0;
  for (size_t i = 0; i < weights.size(); ++i) {
    const double ratio = static_cast<double>(weights[i] / largest), kept = rows.prob(1, i) / unit;
    sum += rows.prob(1, i);
    if (ratio > std::exp2(-21))
      EXPECT_NEAR(std::log2(kept / ratio), 0, 1.001 / 24) << i;
    else
      EXPECT_LT(kept, std::exp2(-20.9)) << i;
  }
  EXPECT_NEAR(sum, 1, 1e-12);
  EXPECT_EQ(rows.prob(1, 17), 0);
}

TEST(CompactDistributions, TakeAByteForEachLight) {
  EXPECT_LT(CompactDistributions::bytes_for(30'000, 15'000), size_t{512} << 20);
  EXPECT_EQ(CompactDistributions(3, 1000).bytes(), CompactDistributions::bytes_for(3, 1000));
}

TEST(ImportanceCache, TakesNoMoreMemoryThanItMay) {
  CacheSettings settings;
  settings.points = {500, 500, 0};
  settings.memory = 300'000;
  size_t asked = 0;
  const ImportanceCache cache(settings, 1000, {1, 1, 1}, [&](PlaceKind, size_t, std::span<float> weights) {
    weights[0] = 1;
    return ImportanceCache::Record{Vec3(static_cast<float>(asked++)), Vec3(0), true};
  });
  EXPECT_TRUE(cache.is_cut());
  EXPECT_LE(cache.bytes(), settings.memory);
  EXPECT_GT(cache.points(), 250u);
}

TEST(KdTree, FindsTheNearest) {
  Rng rng(5);
  std::vector<KdTree<3>::Point> points(500);
  for (auto& p : points) p = {rng.next_float(), std::floor(4 * rng.next_float()), rng.next_float()};
  const KdTree<3> tree(points);
  for (int i = 0; i < 200; ++i) {
    const KdTree<3>::Point place{2 * rng.next_float(), 4 * rng.next_float(), rng.next_float()};
    std::vector<float> distances;
    for (const auto& p : points)
      distances.push_back((p[0] - place[0]) * (p[0] - place[0]) + (p[1] - place[1]) * (p[1] - place[1]) +
                          (p[2] - place[2]) * (p[2] - place[2]));
    std::sort(distances.begin(), distances.end());
    std::array<KdTree<3>::Neighbour, 4> found;
    ASSERT_EQ(tree.nearest(place, found), 4u);
    for (size_t m = 0; m < 4; ++m) EXPECT_FLOAT_EQ(found[m].distance2, distances[m]);
  }
  std::array<KdTree<3>::Neighbour, 4> found;
  EXPECT_EQ(KdTree<3>().nearest({0, 0, 0}, found), 0u);
}

}  // namespace
}  // namespace turbid::testing
