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
};

Path random_path(Rng& rng, int k) {
  const auto number = [&] { return std::exp(8 * rng.next_double() - 4); };
  Path path{k, {}, {}, {}, {}, {}, number(), number(), number(), number(), rng.next_double() < 0.7};
  for (int i = 0; i <= k; ++i) {
    const bool inside = i > 0 && i < k;
    path.delta.push_back(inside && rng.next_double() < 0.25);
    path.from_light_w.push_back(path.delta.back() ? 1 : number());
    path.from_sensor_w.push_back(path.delta.back() ? 1 : number());
    path.towards_sensor.push_back(number());
    path.towards_light.push_back(number());
  }
  return path;
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

/// Sum over the other strategies of (p_j / p_s)^b by the recursion.
double others(const Path& path, const StrategyWeights& weights, int s) {
  const auto index = [](int i) { return static_cast<size_t>(i); };
  const auto departure = [&](int i, bool from_light) {
    const double towards_sensor = path.from_light_w[index(i)], towards_light = path.from_sensor_w[index(i)];
    return StrategyWeights::Departure{path.delta[index(i)], from_light ? towards_sensor : towards_light,
                                      from_light ? towards_light : towards_sensor};
  };
  // From the light to vertex s - 1.
  StrategySums light{1 / (path.start_w * path.towards_sensor[0]), weights.power(path.direct / path.start),
                     path.light_can_be_hit ? weights.power(path.towards_light[0] / path.start) : 0};
  for (int i = 1; i < s - 1; ++i)
    light = weights.next(light, departure(i, true), path.towards_sensor[index(i)], path.towards_light[index(i)]);
  // From the sensor to vertex s.
  StrategySums sensor{1 / path.sensor, 1, 0};
  for (int i = path.k - 1; i > s; --i)
    sensor =
        weights.next(sensor, departure(i, false), path.towards_light[index(i - 1)], path.towards_sensor[index(i - 1)]);

  if (s == 0)
    return weights.power(path.direct * sensor.inverse_pdf) * sensor.joint +
           weights.power(path.start * sensor.inverse_pdf) * weights.power(path.start_w) * sensor.behind;
  const double light_made_by_sensor =
      s == path.k ? path.sensor : path.from_sensor_w[index(s)] * path.towards_light[index(s - 1)];
  if (s == 1)
    return (path.light_can_be_hit ? weights.power(light_made_by_sensor / path.direct) : 0) +
           weights.others(sensor, path.start * path.start_w * path.towards_sensor[0] / path.direct,
                          path.from_light_w[1]);
  const double sum = weights.others(light, light_made_by_sensor, path.from_sensor_w[index(s - 1)]);
  if (s == path.k) return sum;
  return sum + weights.others(sensor, path.from_light_w[index(s - 1)] * path.towards_sensor[index(s - 1)],
                              path.from_light_w[index(s)]);
}

TEST(StrategySums, AreThoseOfAllDensitiesMultipliedOut) {
  Rng rng(3);
  for (const auto heuristic : {StrategyWeights::Heuristic::kBalance, StrategyWeights::Heuristic::kPower}) {
    const StrategyWeights weights(heuristic);
    for (int n = 0; n < 20000; ++n) {
      const Path path = random_path(rng, 2 + static_cast<int>(rng.next_u32() % 9));
      const std::vector<double> densities = all_densities(path);
      double total = 0;
      for (const double p : densities) total += weights.power(p);
      double sum_of_weights = 0;
      for (int s = 0; s <= path.k; ++s) {
        const double p = densities[static_cast<size_t>(s)];
        if (p == 0) continue;
        const double weight = 1 / (1 + others(path, weights, s));
        ASSERT_NEAR(weight * total / weights.power(p), 1, 1e-9) << "s " << s << " of " << path.k;
        sum_of_weights += weight;
      }
      if (total > 0) {
        ASSERT_NEAR(sum_of_weights, 1, 1e-9);
      }
    }
  }
}

TEST(StrategySums, TwinNoticesAWrongDensity) {
  Rng rng(4);
  const StrategyWeights weights(StrategyWeights::Heuristic::kPower);
  Path path = random_path(rng, 5);
  std::fill(path.delta.begin(), path.delta.end(), false);
  const std::vector<double> densities = all_densities(path);
  double total = 0;
  for (const double p : densities) total += weights.power(p);
  const auto weight = [&] { return total / weights.power(densities[3]) / (1 + others(path, weights, 3)); };
  EXPECT_NEAR(weight(), 1, 1e-9);
  path.from_sensor_w[2] *= 1.5;
  EXPECT_GT(std::abs(weight() - 1), 1e-9);
}

}  // namespace
}  // namespace turbid
