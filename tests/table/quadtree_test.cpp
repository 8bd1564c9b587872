// Mode `seed`: the quadtree, lobes of samples, and light that photons left in them.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <fstream>
#include <map>
#include <numbers>

#include "core/error.h"
#include "core/rng.h"
#include "image/atomic_file.h"
#include "medium/henyey_greenstein.h"
#include "medium/isotropic.h"
#include "table/multiple_scattering.h"
#include "table/quadtree_file.h"
#include "table/table_cache.h"
#include "table/table_file.h"
#include "table/tables_for_tests.h"
#include "testing/temporary_folder.h"

namespace turbid::testing {
namespace {

using std::numbers::pi;

std::vector<Quadtree::Place> places_near_source(size_t count) {
  Rng rng(3);
  std::vector<Quadtree::Place> places;
  for (size_t i = 0; i < count; ++i) {
    const float r = -4 * std::log(1 - rng.next_float()), c = 2 * rng.next_float() - 0.7f;
    places.push_back({r * std::sqrt(std::max(0.0f, 1 - c * c)), r * c});
  }
  return places;
}

TEST(Quadtree, CoversItsPlacesOnce) {
  const Quadtree tree(32, places_near_source(20000), {});
  EXPECT_GT(tree.leaf_count(), 300u);
  double volume = 0;
  float smallest = 32;
  for (const Quadtree::Leaf& leaf : tree.leaves()) {
    volume += Quadtree::volume(leaf);
    smallest = std::min(smallest, leaf.size);
    const Quadtree::Leaf found = tree.find({leaf.rho + 0.9f * leaf.size, leaf.z + 0.1f * leaf.size});
    EXPECT_EQ(found.number, leaf.number);
    EXPECT_EQ(found.size, leaf.size);
  }
  EXPECT_NEAR(volume / (pi * 32 * 32 * 48), 1, 1e-6);
  EXPECT_LE(smallest, 0.25f);
  EXPECT_TRUE(tree.holds({0, -15.9f}));
  EXPECT_FALSE(tree.holds({0, -16.1f}));
  EXPECT_FALSE(tree.holds({32, 0}));
}

TEST(Quadtree, KeepsItsLimits) {
  const std::vector<Quadtree::Place> places = places_near_source(20000);
  EXPECT_LE(Quadtree(32, places, {.leaves = 100}).leaf_count(), 100u);
  // A cell that holds more than its share has been cut.
  const Quadtree tree(32, places, {.leaves = 100000, .share = 1e-3});
  std::vector<int> counts(tree.leaf_count());
  for (const Quadtree::Place& place : places)
    if (tree.holds(place)) ++counts[static_cast<size_t>(tree.find(place).number)];
  for (const Quadtree::Leaf& leaf : tree.leaves())
    if (leaf.size > 0.1f) {
      EXPECT_LE(counts[static_cast<size_t>(leaf.number)], 20) << leaf.size;
    }
}

TEST(Quadtree, ComesBackFromItsNodes) {
  const Quadtree tree(32, places_near_source(3000), {});
  const Quadtree again(32, tree.nodes());
  EXPECT_EQ(again.leaf_count(), tree.leaf_count());
  EXPECT_EQ(again.find({3.3f, 1}).number, tree.find({3.3f, 1}).number);
  for (const size_t wrong : {size_t{0}, size_t{5}, tree.nodes().size() - 1}) {
    std::vector<int32_t> nodes = tree.nodes();
    nodes[wrong] += 4;
    EXPECT_THROW(Quadtree(32, nodes), std::invalid_argument) << wrong;
  }
  EXPECT_THROW(Quadtree(32, std::vector<int32_t>{}), std::invalid_argument);
}

/// Lobes computed from a function of the direction, the same in all channels but for a factor.
template <class Lobe>
std::vector<float> compute(const Lobe& lobe) {
  const LobeDirections directions;
  std::vector<float> values;
  for (int c = 0; c < kChannels; ++c)
    for (size_t k = 0; k < LobeDirections::kCount; ++k)
      values.push_back(static_cast<float>(c + 1) * lobe(Vec3(directions.x[k], directions.y[k], directions.z[k])));
  return values;
}

/// Root of the mean square difference over the mean square.
template <class Lobe>
double lobe_error(const SampledLobe& sampled, int channel, const Lobe& lobe) {
  const LobeDirections directions;
  double square = 0, difference = 0;
  for (size_t k = 0; k < LobeDirections::kCount; ++k) {
    const Vec3 d(directions.x[k], directions.y[k], directions.z[k]);
    const double expected = static_cast<double>(static_cast<float>(channel + 1) * lobe(d));
    square += static_cast<double>(directions.solid_angle[k]) * sqr(expected);
    difference +=
        static_cast<double>(directions.solid_angle[k]) * sqr(static_cast<double>(sampled.eval(channel, d)) - expected);
  }
  return std::sqrt(difference / square);
}

TEST(SampledLobe, FindsTheAxisOfASymmetricLobe) {
  for (const float angle : {0.0f, 0.7f, -1.2f, 2.5f}) {
    const Vec3 axis(std::sin(angle), 0, std::cos(angle));
    const auto lobe = [&](const Vec3& d) { return std::exp(2 * dot(d, axis)); };
    for (const bool asymmetric : {false, true}) {
      std::vector<float> numbers(SampledLobe::size(asymmetric));
      SampledLobe::fit(compute(lobe).data(), asymmetric, numbers.data());
      const SampledLobe sampled(numbers.data(), asymmetric);
      EXPECT_NEAR(sampled.axis(), angle, 0.03f);
      for (int c = 0; c < kChannels; ++c) {
        EXPECT_LT(lobe_error(sampled, c, lobe), 0.03) << angle << " " << asymmetric;
        // int e^(2 mu) = 2 pi sinh(2).
        EXPECT_NEAR(sampled.integral(c) / static_cast<float>(c + 1), 2 * pi * std::sinh(2), 0.02);
      }
      numbers[0] += 0.3f;
      EXPECT_GT(lobe_error(sampled, 0, lobe), 0.1) << "another axis is not noticed";
    }
  }
}

TEST(SampledLobe, HoldsTwoSidesAndACoronalSection) {
  // Narrower across the sagittal plane than in it, and skew.
  const auto lobe = [](const Vec3& d) { return std::exp(2 * d.z - 2 * d.y * d.y) * (1 + 0.2f * d.x); };
  std::vector<float> symmetric(SampledLobe::size(false)), asymmetric(SampledLobe::size(true));
  SampledLobe::fit(compute(lobe).data(), false, symmetric.data());
  SampledLobe::fit(compute(lobe).data(), true, asymmetric.data());
  EXPECT_LT(lobe_error(SampledLobe(asymmetric.data(), true), 1, lobe), 0.09);
  EXPECT_GT(lobe_error(SampledLobe(symmetric.data(), false), 1, lobe), 0.12);
  EXPECT_NEAR(SampledLobe(asymmetric.data(), true).integral(1) / SampledLobe(symmetric.data(), false).integral(1), 1,
              1e-4f);
}

TEST(SampledLobe, OfNothingIsNothing) {
  const std::vector<float> dark(kChannels * LobeDirections::kCount);
  std::vector<float> numbers(SampledLobe::size(true), 7);
  SampledLobe::fit(dark.data(), true, numbers.data());
  EXPECT_EQ(SampledLobe(numbers.data(), true).integral(0), 0);
  EXPECT_EQ(SampledLobe(numbers.data(), true).eval(0, {0, 0, 1}), 0);
}

const Spectrum kAlbedo(0.9f, 0.8f, 0.5f);
/// For what does not depend on how fine cells are.
constexpr Quadtree::Limits kCoarse{.leaves = 500};
constexpr QuadtreeSettings kFew{.seed = 1, .photons = 40'000};

/// Tests share them.
std::shared_ptr<const QuadtreeTable> few_photons(float g) {
  static std::map<float, std::shared_ptr<const QuadtreeTable>> tables;
  std::shared_ptr<const QuadtreeTable>& table = tables[g];
  if (!table) table = std::make_shared<QuadtreeTable>(build_quadtree_table(HenyeyGreensteinPhase(g), kAlbedo, kFew));
  return table;
}

/// Energies of a table over those of a medium of another albedo: how far off is the worst?
double energy_error(const std::shared_ptr<const QuadtreeTable>& table, const Spectrum& told) {
  double worst = 0;
  for (const SourceKind kind : {SourceKind::kCollision, SourceKind::kRay})
    for (int c = 0; c < kChannels; ++c) {
      const double flux = kind == SourceKind::kRay ? -std::expm1(-2.0) : 1, albedo = static_cast<double>(told[c]);
      const double energy = measure_moments(QuadtreeField(table, kind, c), table->kind(kind).tree).energy;
      worst = std::max(worst, std::abs(energy / (flux * std::pow(albedo, 3) / (1 - albedo)) - 1));
    }
  return worst;
}

// Where little light reaches the end of the cells, all of it is in them.
TEST(QuadtreeTable, HasTheEnergyOfItsOrders) {
  for (const float g : {0.0f, 0.7f}) {
    const auto table = few_photons(g);
    EXPECT_LT(energy_error(table, kAlbedo), 0.02) << g;
    EXPECT_GT(energy_error(table, kAlbedo * 1.02f), 0.04) << "another albedo is not noticed";
    EXPECT_LE(table->size(), 1'900'000u);
  }
}

/// Light of the table over that of the exact one between two distances from the source.
double shell_ratio(const LightField& field, const LightField& exact, double inner, double outer) {
  const Vec3 axis(0, 0, 1);
  double found = 0, expected = 0;
  for (int i = 0; i < 40; ++i)
    for (int j = 0; j < 100; ++j) {
      const double r = inner * std::pow(outer / inner, (i + 0.5) / 40), mu = -1 + (j + 0.5) / 50;
      const Vec3 x(Imath::V3d(r * std::sqrt(1 - mu * mu), 0, r * mu));
      found += r * r * r * static_cast<double>(field.density(x, axis));
      expected += r * r * r * static_cast<double>(exact.density(x, axis));
    }
  return found / expected;
}

// Near the source, where cells are small, and far away, where light falls off within a cell: each keeps what is its
// own.
TEST(QuadtreeTable, HasTheLightOfEachShell) {
  const auto table = few_photons(0);
  const ScatteringTable& exact = small_table(0);
  const LobeField collision(exact, SourceKind::kCollision, 0.9), ray(exact, SourceKind::kRay, 0.9);
  const StretchField segment(ray, kUnitSegment);
  for (const auto& [inner, outer] : {std::pair{0.25, 1.0}, {1.0, 2.0}, {2.0, 4.0}, {4.0, 8.0}, {8.0, 16.0}}) {
    const double tolerance = outer > 10 ? 0.05 : 0.02;
    const QuadtreeField points(table, SourceKind::kCollision, 0), segments(table, SourceKind::kRay, 0);
    EXPECT_NEAR(shell_ratio(points, collision, inner, outer), 1, tolerance) << outer;
    EXPECT_NEAR(shell_ratio(segments, segment, inner, outer), 1, tolerance) << outer;
    const LobeField other(exact, SourceKind::kCollision, 0.88);
    EXPECT_GT(std::abs(shell_ratio(points, other, inner, outer) - 1), tolerance) << "another albedo is not noticed";
  }
}

/// How far its light is from the exact table's.
LobeDifference against_exact(const std::shared_ptr<const QuadtreeTable>& table, int channel, float g, double albedo) {
  const LobeField exact(small_table(g), SourceKind::kCollision, albedo);
  return compare_within(exact, QuadtreeField(table, SourceKind::kCollision, channel), exact.grid());
}

TEST(QuadtreeTable, MeetsTheExactOne) {
  const auto table = few_photons(0.7f);
  const LobeDifference same = against_exact(table, 0, 0.7f, 0.9), other = against_exact(table, 0, 0.7f, 0.8);
  std::printf("g 0.7, albedo 0.9: lobes %.1f %%, density %.1f %%, shape %.1f %%\n", 100 * same.lobes,
              100 * same.density, 100 * same.shape);
  EXPECT_LT(same.lobes, 0.25);
  EXPECT_LT(same.shape, 0.2);
  EXPECT_GT(other.lobes, 2 * same.lobes) << "another albedo is not noticed";
}

TEST(QuadtreeTable, IsTheSameForAnyNumberOfThreads) {
  const auto build = [&](size_t threads, uint64_t seed) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return build_quadtree_table(HenyeyGreensteinPhase(0.5f), Spectrum(0.5f, 0.4f, 0), {seed, 3000}, kCoarse);
  };
  const QuadtreeTable one = build(1, 4), two = build(2, 4);
  EXPECT_EQ(one.kinds[0].lobes, two.kinds[0].lobes);
  EXPECT_EQ(one.kinds[1].lobes, two.kinds[1].lobes);
  EXPECT_NE(one.kinds[0].lobes, build(1, 5).kinds[0].lobes);
}

TEST(QuadtreeTable, FromHigherOrders) {
  const Spectrum albedo(0.7f);
  for (const int from : {4, 5}) {
    const auto table =
        std::make_shared<QuadtreeTable>(build_quadtree_table(IsotropicPhase(), albedo, {1, 20'000, from}, kCoarse));
    const double energy =
        measure_moments(QuadtreeField(table, SourceKind::kCollision, 0), table->kind(SourceKind::kCollision).tree)
            .energy;
    EXPECT_NEAR(energy / (std::pow(0.7, from) / 0.3), 1, 0.04) << from;
  }
}

TEST(QuadtreeTable, RefusesWhatHasNoSum) {
  try {
    build_quadtree_table(IsotropicPhase(), Spectrum(0.5f, 0.5f, 1), kFew);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("albedos from 0 to 0.9995, not 1"), std::string::npos) << error.what();
  }
}

// A stretch is the sum of its unit segments and what is left.
TEST(QuadtreeTable, StretchesOfAnyLength) {
  const Spectrum albedo = kAlbedo;
  const auto table = few_photons(0);
  const MultipleScattering light(HomogeneousMedium(Spectrum(1.0f), albedo, std::make_shared<IsotropicPhase>()),
                                 quadtree_lights(table));
  const MultipleScattering exact(HomogeneousMedium(Spectrum(1.0f), albedo, std::make_shared<IsotropicPhase>()),
                                 small_table(0));
  const auto mean_ratio = [&](float depth, float told) {
    Rng rng(5);
    double found = 0, expected = 0;
    for (int i = 0; i < 4000; ++i) {
      const float u = rng.next_float();
      const Vec3 x = square_to_sphere({u, rng.next_float()}) * (1 + 5 * rng.next_float());
      found += static_cast<double>(light.source_radiance(Stretch{Vec3(0), {0, 0, 1}, depth}, x, {1, 0, 0})[0]);
      expected += static_cast<double>(exact.source_radiance(Stretch{Vec3(0), {0, 0, 1}, told}, x, {1, 0, 0})[0]);
    }
    return found / expected;
  };
  for (const float depth : {0.1f, 0.7f, 1.9f, 2.0f, 3.0f, 7.3f, kInfinity})
    EXPECT_NEAR(mean_ratio(depth, depth), 1, 0.02) << depth;
  EXPECT_GT(std::abs(mean_ratio(2, 1.4f) - 1), 0.05) << "another length is not noticed";
}

TEST(QuadtreeFile, ComesBackAsItWasAndDamageIsFound) {
  const QuadtreeTable table =
      build_quadtree_table(HenyeyGreensteinPhase(0.3f), Spectrum(0.4f, 0.3f, 0.2f), {3, 2000}, kCoarse);
  const std::string bytes = encode_quadtree(table);
  EXPECT_EQ(encode_quadtree(table), bytes);
  const QuadtreeTable back = decode_quadtree(bytes, "memory");
  EXPECT_EQ(back.moments, table.moments);
  EXPECT_EQ(back.albedo, table.albedo);
  EXPECT_EQ(back.settings.photons, table.settings.photons);
  for (size_t k = 0; k < kSourceKinds; ++k) {
    EXPECT_EQ(back.kinds[k].lobes, table.kinds[k].lobes);
    EXPECT_EQ(back.kinds[k].factors, table.kinds[k].factors);
    EXPECT_EQ(back.kinds[k].tree.nodes(), table.kinds[k].tree.nodes());
  }
  const auto is_refused = [](const std::string& damaged) {
    try {
      decode_quadtree(damaged, "x.h5");
      return false;
    } catch (const FileError& error) {
      return std::string(error.what()).rfind("x.h5: this is not a usable table of multiple scattering: ", 0) == 0;
    }
  };
  EXPECT_TRUE(is_refused(""));
  EXPECT_TRUE(is_refused(bytes.substr(0, bytes.size() / 2)));
  EXPECT_TRUE(is_refused(encode_table(small_table(0)))) << "a table of the other mode";
  Rng rng(1);
  int found = 0;
  for (int i = 0; i < 40; ++i) {
    std::string damaged = bytes;
    damaged[rng.next_u32() % damaged.size()] ^= static_cast<char>(1 << rng.next_u32() % 8);
    found += is_refused(damaged);
  }
  EXPECT_GT(found, 20);
}

TEST(QuadtreeFile, CacheBuildsOnceAndReplacesWhatIsDamaged) {
  const TemporaryFolder folder;
  const IsotropicPhase phase;
  const Spectrum albedo(0.5f, 0.4f, 0.3f);
  const QuadtreeSettings settings{1, 500};
  const std::string path = quadtree_path(phase, albedo, settings, folder.file("tables"));
  EXPECT_NE(path, quadtree_path(phase, albedo * 0.9f, settings, folder.file("tables")));
  EXPECT_NE(path, quadtree_path(phase, albedo, {1, 501}, folder.file("tables")));
  const std::vector<float> lobes = find_quadtree(phase, albedo, settings, folder.file("tables"))->kinds[0].lobes;
  const std::string bytes = read_file(path);
  for (const std::string& wrong : {bytes.substr(0, 1000), encode_table(small_table(0)), std::string("x")}) {
    std::ofstream(path, std::ios::binary) << wrong;
    ::testing::internal::CaptureStderr();
    EXPECT_EQ(find_quadtree(phase, albedo, settings, folder.file("tables"))->kinds[0].lobes, lobes);
    EXPECT_NE(::testing::internal::GetCapturedStderr().find("built anew"), std::string::npos);
    EXPECT_EQ(read_file(path), bytes);
  }
}

}  // namespace
}  // namespace turbid::testing
