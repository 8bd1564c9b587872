// The recursive sums against their plain twin: all densities of a path multiplied out.
#include "path/strategy_sums.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/rng.h"

namespace turbid {
namespace {

/// The numbers that a path's weights depend on. Vertex 0 lies on the light, vertex k on the sensor.
struct Path {
  int k;
  std::vector<bool> delta;            ///< vertices that leave no choice of direction
  std::vector<double> from_light_w;   ///< vertex i: density of the direction to i + 1, for a walk that comes from i - 1
  std::vector<double> from_sensor_w;  ///< vertex i: density of the direction to i - 1, for a walk that comes from i + 1
  std::vector<double> towards_sensor;  ///< edge i: turns 1/sr at i into 1/area at i + 1
  std::vector<double> towards_light;   ///< edge i: turns 1/sr at i + 1 into 1/area at i
  double start, start_w;               ///< of the light's walk: the point, and the direction
  double direct;                       ///< next-event estimation, per area on the light
  double sensor;                       ///< with which the sensor's walk makes vertex k - 1, per area
  bool light_can_be_hit;
  std::vector<Merges> merges;  ///< at vertex i: powers of the measures, over the density that both walks make it with
};

Path random_path(Rng& rng, int k, bool merge) {
  const auto number = [&] { return std::exp(8 * rng.next_double() - 4); };
  Path path{k, {}, {}, {}, {}, {}, number(), number(), number(), number(), rng.next_double() < 0.7, {}};
  for (int i = 0; i <= k; ++i) {
    const bool inside = i > 0 && i < k;
    path.delta.push_back(inside && rng.next_double() < 0.25);
    path.from_light_w.push_back(path.delta.back() ? 1 : number());
    path.from_sensor_w.push_back(path.delta.back() ? 1 : number());
    path.towards_sensor.push_back(number());
    path.towards_light.push_back(number());
    Merges merges;
    if (merge && inside && !path.delta.back()) {
      const auto measure = [&] { return rng.next_double() < 0.3 ? 0.0 : number(); };
      merges = {measure(), measure(), measure(), measure()};
    }
    path.merges.push_back(merges);
  }
  return path;
}

/// The density of the light's walk up to vertex i, and of the sensor's down to it; both with the vertex.
double made_from_light(const Path& path, int i) {
  double p = path.start * path.start_w * path.towards_sensor[0];
  for (int j = 2; j <= i; ++j)
    p *= path.from_light_w[static_cast<size_t>(j - 1)] * path.towards_sensor[static_cast<size_t>(j - 1)];
  return p;
}
double made_from_sensor(const Path& path, int i) {
  double p = path.sensor;
  for (int j = path.k - 2; j >= i; --j)
    p *= path.from_sensor_w[static_cast<size_t>(j + 1)] * path.towards_light[static_cast<size_t>(j)];
  return p;
}

/// The powers of the densities of all merges at vertex i.
std::vector<double> merge_powers(const Path& path, const StrategyWeights& weights, int i) {
  const double both = weights.power(made_from_light(path, i) * made_from_sensor(path, i));
  const Merges& m = path.merges[static_cast<size_t>(i)];
  return {both * m.point_point, both * m.point_beam, both * m.beam_point, both * m.beam_beam};
}

/// p_s for s = 0 ... k; 0 where the strategy does not exist.
std::vector<double> all_densities(const Path& path) {
  const auto index = [](int i) { return static_cast<size_t>(i); };
  std::vector<double> result;
  for (int s = 0; s <= path.k; ++s) {
    double p = 1;
    if (s == 0 && !path.light_can_be_hit) p = 0;
    if (s == 1) p *= path.direct;
    if (s >= 2) p *= path.start * path.start_w * path.towards_sensor[0];
    for (int i = 2; i < s; ++i) p *= path.from_light_w[index(i - 1)] * path.towards_sensor[index(i - 1)];
    for (int i = s; i < path.k; ++i)
      p *= i == path.k - 1 ? path.sensor : path.from_sensor_w[index(i + 1)] * path.towards_light[index(i)];
    if (s > 0 && (path.delta[index(s - 1)] || path.delta[index(s)])) p = 0;
    result.push_back(p);
  }
  return result;
}

StrategyWeights::Departure departure(const Path& path, int vertex, bool from_light) {
  const auto i = static_cast<size_t>(vertex);
  const double towards_sensor = path.from_light_w[i], towards_light = path.from_sensor_w[i];
  return {path.delta[i], from_light ? towards_sensor : towards_light, from_light ? towards_light : towards_sensor,
          path.merges[i].sum()};
}

/// The sums of the walk from the light at vertex i, and of that from the sensor.
StrategySums light_sums(const Path& path, const StrategyWeights& weights, int i) {
  StrategySums sums{1 / (path.start_w * path.towards_sensor[0]), weights.power(path.direct / path.start),
                    path.light_can_be_hit ? weights.power(path.towards_light[0] / path.start) : 0};
  for (int j = 1; j < i; ++j)
    sums = weights.next(sums, departure(path, j, true), path.towards_sensor[static_cast<size_t>(j)],
                        path.towards_light[static_cast<size_t>(j)]);
  return sums;
}
StrategySums sensor_sums(const Path& path, const StrategyWeights& weights, int i) {
  StrategySums sums{1 / path.sensor, 1, 0};
  for (int j = path.k - 1; j > i; --j)
    sums = weights.next(sums, departure(path, j, false), path.towards_light[static_cast<size_t>(j - 1)],
                        path.towards_sensor[static_cast<size_t>(j - 1)]);
  return sums;
}

/// Sum over the other strategies of (p_j / p_s)^b by the recursion.
double others(const Path& path, const StrategyWeights& weights, int s) {
  const auto index = [](int i) { return static_cast<size_t>(i); };
  const StrategySums light = light_sums(path, weights, s - 1), sensor = sensor_sums(path, weights, s);
  if (s == 0)
    return weights.power(path.direct * sensor.inverse_pdf) * sensor.joint +
           weights.power(path.start * sensor.inverse_pdf) * weights.power(path.start_w) * sensor.behind;
  const double light_made_by_sensor =
      s == path.k ? path.sensor : path.from_sensor_w[index(s)] * path.towards_light[index(s - 1)];
  if (s == 1)
    return (path.light_can_be_hit ? weights.power(light_made_by_sensor / path.direct) : 0) +
           weights.others(sensor, path.start * path.start_w * path.towards_sensor[0] / path.direct,
                          path.from_light_w[1], path.merges[1].sum());
  const double sum =
      weights.others(light, light_made_by_sensor, path.from_sensor_w[index(s - 1)], path.merges[index(s - 1)].sum());
  if (s == path.k) return sum;
  return sum + weights.others(sensor, path.from_light_w[index(s - 1)] * path.towards_sensor[index(s - 1)],
                              path.from_light_w[index(s)], path.merges[index(s)].sum());
}

/// What is beside the merges at vertex i in the denominator of their weights, by the recursion.
double beside_merge(const Path& path, const StrategyWeights& weights, int i) {
  return weights.beside_merge(light_sums(path, weights, i), path.from_sensor_w[static_cast<size_t>(i)]) +
         weights.beside_merge(sensor_sums(path, weights, i), path.from_light_w[static_cast<size_t>(i)]);
}

/// The sum of the powers of all densities, multiplied out.
double total_power(const Path& path, const StrategyWeights& weights) {
  double total = 0;
  for (const double p : all_densities(path)) total += weights.power(p);
  for (int i = 1; i < path.k; ++i)
    for (const double power : merge_powers(path, weights, i)) total += power;
  return total;
}

class StrategySumsOf : public ::testing::TestWithParam<std::pair<StrategyWeights::Heuristic, bool>> {};

TEST_P(StrategySumsOf, AreThoseOfAllDensitiesMultipliedOut) {
  Rng rng(3);
  const auto [heuristic, merge] = GetParam();
  const StrategyWeights weights(heuristic);
  for (int n = 0; n < 20000; ++n) {
    const Path path = random_path(rng, 2 + static_cast<int>(rng.next_u32() % 9), merge);
    const std::vector<double> densities = all_densities(path);
    const double total = total_power(path, weights);
    double sum_of_weights = 0;
    for (int s = 0; s <= path.k; ++s) {
      const double p = densities[static_cast<size_t>(s)];
      if (p == 0) continue;
      const double weight = 1 / (1 + others(path, weights, s));
      ASSERT_NEAR(weight * total / weights.power(p), 1, 1e-9) << "s " << s << " of " << path.k;
      sum_of_weights += weight;
    }
    for (int i = 1; i < path.k; ++i) {
      const Merges& m = path.merges[static_cast<size_t>(i)];
      if (!(m.sum() > 0)) continue;
      const std::vector<double> powers = merge_powers(path, weights, i);
      const double beside = beside_merge(path, weights, i),
                   own[] = {m.point_point, m.point_beam, m.beam_point, m.beam_beam};
      for (size_t kind = 0; kind < powers.size(); ++kind) {
        const double weight = StrategyWeights::merge_weight(own[kind], m.sum(), beside);
        ASSERT_NEAR(weight, powers[kind] / total, 1e-9) << "merge " << kind << " at " << i << " of " << path.k;
        sum_of_weights += weight;
      }
    }
    if (total > 0) {
      ASSERT_NEAR(sum_of_weights, 1, 1e-9);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Heuristics, StrategySumsOf,
                         ::testing::Values(std::pair(StrategyWeights::Heuristic::kBalance, false),
                                           std::pair(StrategyWeights::Heuristic::kPower, false),
                                           std::pair(StrategyWeights::Heuristic::kBalance, true),
                                           std::pair(StrategyWeights::Heuristic::kPower, true)));

/// Merges are worth what their kernels measure: known cases.
TEST(StrategySums, MergesByKindOfMedium) {
  const StrategyWeights weights(StrategyWeights::Heuristic::kBalance, {1, 2, 3, 4, 5, 6});
  const Merges at = weights.merges_at(0.5, 0.6f);
  EXPECT_DOUBLE_EQ(weights.merged_at_surface(), 1);
  EXPECT_DOUBLE_EQ(at.point_point, 2);
  EXPECT_DOUBLE_EQ(at.point_beam, 3 / 0.5);
  EXPECT_DOUBLE_EQ(at.beam_point, 4 / 0.5);
  EXPECT_NEAR(at.beam_beam, 5 * 0.8 / 0.25, 1e-6);
  const Merges inhomogeneous = weights.merges_at(0, 0.6f);
  EXPECT_DOUBLE_EQ(inhomogeneous.sum(), 6);
}

/// In dense media kernels shrink with the mean free path, each in its own dimension.
TEST(StrategySums, MergesOfSmallerKernels) {
  const StrategyWeights weights(StrategyWeights::Heuristic::kBalance, {1, 2, 3, 4, 5, 6, 10});
  EXPECT_DOUBLE_EQ(weights.kernel_scale(10), 1);
  EXPECT_DOUBLE_EQ(weights.kernel_scale(40), 0.25);
  const Merges whole = weights.merges_at(40, 0.6f), part = weights.merges_at(40, 0.6f, 0.25);
  EXPECT_DOUBLE_EQ(part.point_point, whole.point_point / 64);
  EXPECT_DOUBLE_EQ(part.point_beam, whole.point_beam / 16);
  EXPECT_DOUBLE_EQ(part.beam_point, whole.beam_point / 16);
  EXPECT_DOUBLE_EQ(part.beam_beam, whole.beam_beam / 4);
}

TEST(StrategySums, TwinNoticesAWrongDensity) {
  Rng rng(4);
  const StrategyWeights weights(StrategyWeights::Heuristic::kPower);
  Path path = random_path(rng, 5, true);
  std::fill(path.delta.begin(), path.delta.end(), false);
  path.merges[2].point_beam = 1;
  const double total = total_power(path, weights), power = weights.power(all_densities(path)[3]);
  const double merge = merge_powers(path, weights, 2)[1];
  const auto weight = [&] { return total / power / (1 + others(path, weights, 3)); };
  const auto weight_of_merge = [&] {
    return total / merge * StrategyWeights::merge_weight(1, path.merges[2].sum(), beside_merge(path, weights, 2));
  };
  EXPECT_NEAR(weight(), 1, 1e-9);
  EXPECT_NEAR(weight_of_merge(), 1, 1e-9);
  path.from_sensor_w[2] *= 1.5;
  EXPECT_GT(std::abs(weight() - 1), 1e-9);
  EXPECT_GT(std::abs(weight_of_merge() - 1), 1e-9);
  path.from_sensor_w[2] /= 1.5;
  path.merges[2].point_point += path.merges[2].sum();
  EXPECT_GT(std::abs(weight_of_merge() - 1), 1e-9);
}

}  // namespace
}  // namespace turbid
