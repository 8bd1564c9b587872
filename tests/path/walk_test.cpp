// Light paths on their own: what they carry where a closed form says it, and the correction for shading normals.
#include "path/walk.h"

#include <gtest/gtest.h>

#include <map>

#include "scene/loader.h"

namespace turbid {
namespace {

constexpr int kPaths = 100000;

Scene load(const std::string& content) {
  return Scene(load_scene_from_string("<scene version=\"3.0.0\"><sensor type=\"perspective\"/>" + content + "</scene>",
                                      "test scene")
                   .parts);
}

std::string fog_ball(float sigma_t) {
  return R"(<shape type="sphere"><float name="radius" value="2"/><bsdf type="null"/>
    <medium name="interior" type="homogeneous"><float name="sigma_t" value=")" +
         std::to_string(sigma_t) + R"("/><rgb name="albedo" value="0.9, 0.5, 0.2"/></medium></shape>)";
}

/// Sums what arrives in events of each order, and the lengths of the first segments.
struct Sums : WalkRecorder {
  void at_emitter(const Emission& emission, const Traveller&) { emitted += emission.throughput; }
  void at_surface(const SurfaceEvent&, const PathState& state, const Traveller&) { on_surfaces += state.throughput; }
  void at_collision(const CollisionEvent&, const PathState& state, const Traveller&) {
    EXPECT_EQ(state.depth, state.order);
    if (state.order <= 2) collided[state.order - 1] += state.throughput;
  }
  void on_segment(const Ray& segment, const Medium&, const PathState& state, const Traveller::Leg& leg) {
    if (state.order > 0) return;
    first_length += static_cast<double>(segment.t_max);
    if (!leg.collides) ++passed;
  }

  Spectrum emitted{0.0f}, on_surfaces{0.0f}, collided[2] = {Spectrum(0.0f), Spectrum(0.0f)};
  double first_length = 0;
  int passed = 0;
};

Sums walk(const Scene& scene, const PathSettings& settings = {}) {
  const LightSources sources(scene, true);
  Sampler sampler(SamplerKind::kIndependent, 1);
  SampleCounters counters;
  Sums sums;
  LightWalk<Sums> light(scene, settings, sampler, counters, sums);
  for (uint64_t path = 0; path < kPaths; ++path) {
    sampler.start(path, 0);
    light.run(sources);
  }
  EXPECT_EQ(counters.light_paths, uint64_t{kPaths});
  return sums;
}

const std::string kPoint = R"(<emitter type="point"><rgb name="intensity" value="1"/></emitter>)";

// From the middle of a ball of radius 2: the first flight collides with probability 1 - exp(-2 sigma).
TEST(LightWalk, CarriesThePowerOfALightIntoItsFirstCollisions) {
  const Sums sums = walk(load(kPoint + fog_ball(0.7f)));
  const double collide = 1 - std::exp(-1.4), power = 4 * std::numbers::pi, albedo[] = {0.9, 0.5, 0.2};
  const double error = std::sqrt(collide * (1 - collide) / kPaths);
  for (int c = 0; c < kChannels; ++c) {
    EXPECT_NEAR(static_cast<double>(sums.emitted[c]) / kPaths / power, 1, 1e-2);
    EXPECT_NEAR(static_cast<double>(sums.collided[0][c]) / kPaths / power / albedo[c], collide, 4 * error + 1e-3);
  }
  EXPECT_NEAR(static_cast<double>(sums.passed) / kPaths, 1 - collide, 4 * error);
  EXPECT_NEAR(sums.first_length / kPaths, collide / 0.7, 0.02);  // mean of min(exponential, 2)
  // Planted: another extinction must not fit.
  EXPECT_GT(std::abs(static_cast<double>(sums.passed) / kPaths - std::exp(-1.5)), 4 * error);
}

TEST(LightWalk, EndsWhereNoFurtherEdgeIsAllowed) {
  const Scene scene = load(kPoint + fog_ball(5));
  PathSettings settings;
  settings.max_depth = 2;
  EXPECT_FALSE(walk(scene, settings).collided[0].is_black());
  EXPECT_TRUE(walk(scene, settings).collided[1].is_black());
  settings.max_depth = 1;
  EXPECT_TRUE(walk(scene, settings).collided[0].is_black());
  settings.max_depth = 5;
  settings.max_scattering = 1;
  EXPECT_TRUE(walk(scene, settings).collided[1].is_black());
}

// A lamp, a point and a sky: each gives the light paths its own power, whatever its share of the choice is.
TEST(LightSources, GiveEveryLightItsPower) {
  const Scene scene = load(kPoint + R"(<emitter type="constant"><rgb name="radiance" value="0.3"/></emitter>
    <shape type="sphere"><emitter type="area"><rgb name="radiance" value="0.01"/></emitter></shape>)");
  const LightSources sources(scene, true);
  Sampler sampler(SamplerKind::kIndependent, 2);
  std::map<const Emitter*, double> powers;
  std::map<const Emitter*, int> counts;
  for (uint64_t i = 0; i < kPaths; ++i) {
    sampler.start(i, 0);
    const auto emission = sources.sample(sampler);
    ASSERT_TRUE(emission);
    powers[emission->emitter] += static_cast<double>(emission->throughput[0]) / kPaths;
    ++counts[emission->emitter];
  }
  ASSERT_EQ(powers.size(), 3u);
  for (const Emitter* emitter : scene.emitters())
    EXPECT_NEAR(powers[emitter] / static_cast<double>(emitter->power()[0]), 1, 4 / std::sqrt(counts[emitter]));
}

/// What light of a kind brings by rays that are aimed at balls, or not: to each of a few other balls, with the squared
/// error; the share of rays that meet a target, and the largest flux.
struct Aimed {
  std::vector<double> means, errors;
  double share = 0, largest = 0;
};
Aimed aim(const Scene& scene, const std::vector<Ball>& targets) {
  const LightSources sources(scene, true, targets);
  Sampler sampler(SamplerKind::kIndependent, targets.size());
  const Ball probes[] = {{{1, 1, 1}, 0.5f}, {{1.2f, 1, 1}, 0.2f}, {{-1, 0, 0}, 0.8f}};
  const auto meets = [](const Ball& ball, const EmissionSample& ray) {
    const Vec3 way = ball.center - ray.origin;
    return dot(way, ray.direction) > 0 && length(cross(way, ray.direction)) < ball.radius;
  };
  Aimed result;
  std::vector<double> sums(3), squares(3);
  for (uint64_t i = 0; i < kPaths; ++i) {
    sampler.start(i, 0);
    const auto emission = sources.sample(sampler);
    if (!emission) continue;
    const auto flux = static_cast<double>(emission->throughput[0]);
    result.largest = std::max(result.largest, flux);
    result.share += meets({{1, 1, 1}, 0.5f}, emission->ray) ? 1.0 / kPaths : 0;
    for (size_t p = 0; p < 3; ++p)
      if (meets(probes[p], emission->ray)) sums[p] += flux, squares[p] += flux * flux;
  }
  for (size_t p = 0; p < 3; ++p) {
    result.means.push_back(sums[p] / kPaths);
    result.errors.push_back(std::sqrt(squares[p]) / kPaths);
  }
  return result;
}

// Rays that are aimed bring as much everywhere, with more of them where they are wanted and never twice the weight.
TEST(LightSources, AimedRaysBringTheSameLight) {
  const std::string body = R"(<shape type="sphere"><float name="radius" value="3"/><bsdf type="null"/></shape>)";
  const std::string turned = R"(<transform name="to_world"><lookat origin="2, 2, -2" target="0.8, 1, 1" up="0, 1, 0"/>
      </transform>)";
  const std::string kinds[] = {
      R"(<emitter type="point"><point name="position" x="2" y="-1" z="2"/><rgb name="intensity" value="1"/></emitter>)",
      R"(<emitter type="spot"><float name="cutoff_angle" value="40"/>)" + turned + "</emitter>",
      R"(<emitter type="constant"><rgb name="radiance" value="0.3"/></emitter>)",
      R"(<emitter type="directional"><vector name="direction" x="-1" y="-1" z="-1"/></emitter>)",
      R"(<shape type="rectangle">)" + turned +
          R"(<emitter type="area"><rgb name="radiance" value="1"/></emitter></shape>)"};
  std::string all;
  for (const std::string& kind : kinds) all += kind;
  for (const std::string& lights : {kinds[0], kinds[1], kinds[2], kinds[3], kinds[4], all}) {
    const Scene scene = load(body + lights);
    const Aimed plain = aim(scene, {}), aimed = aim(scene, {{{1, 1, 1}, 0.5f}, {{-1, -1, 0}, 0.4f}});
    for (size_t p = 0; p < 3; ++p) {
      const double error = std::hypot(plain.errors[p], aimed.errors[p]);
      EXPECT_NEAR(plain.means[p], aimed.means[p], 4 * error + 1e-6 * plain.means[p]) << lights << ", probe " << p;
    }
    EXPECT_GT(aimed.share, 1.5 * plain.share) << lights;
    EXPECT_LT(aimed.errors[0], plain.errors[0]) << lights;
    EXPECT_LT(aimed.largest, 2.001 * plain.largest) << lights;
  }
}

// Rays from infinity begin where media that fill the world end, aimed or not: further back they would lose light there.
TEST(LightSources, AimedRaysFromInfinityBeginWhereOthersDo) {
  const std::string fog = R"(<medium type="homogeneous" name="medium"><float name="sigma_t" value="0.1"/></medium>)";
  for (const std::string kind :
       {R"(<emitter type="constant"/>)",
        R"(<emitter type="directional"><vector name="direction" x="-1" y="-1" z="-1"/></emitter>)"}) {
    const Scene scene = Scene(load_scene_from_string("<scene version=\"3.0.0\"><sensor type=\"perspective\">" + fog +
                                                         "</sensor>" + kind + fog_ball(1) + "</scene>",
                                                     "test scene")
                                  .parts);
    const auto starts_at = [&](const std::vector<Ball>& targets) {
      const LightSources sources(scene, true, targets);
      Sampler sampler(SamplerKind::kIndependent, 1);
      std::pair<float, float> range{kInfinity, 0};
      for (uint64_t i = 0; i < 1000; ++i) {
        sampler.start(i, 0);
        const float distance = length(sources.sample(sampler)->ray.origin - scene.center());
        range = {std::min(range.first, distance), std::max(range.second, distance)};
      }
      return range;
    };
    const auto plain = starts_at({}), aimed = starts_at({{{0.3f, 1, 0}, 0.5f}});
    EXPECT_GT(plain.first, 2 * scene.radius()) << "the world is larger than its shapes";
    EXPECT_NEAR(aimed.first / plain.first, 1, 1e-3f) << kind;
    EXPECT_NEAR(aimed.second / plain.second, 1, 1e-3f) << kind;
  }
}

TEST(LightSources, KnowTheMediumThatTheyStandIn) {
  Sampler sampler(SamplerKind::kIndependent, 2);
  const auto medium_of_start = [&](const Scene& scene) {
    sampler.start(0, 0);
    return LightSources(scene, true).sample(sampler)->medium;
  };
  const std::string lamp = R"(<shape type="sphere"><float name="radius" value="0.1"/>
    <emitter type="area"><rgb name="radiance" value="1"/></emitter></shape>)";
  const std::string far = R"(<emitter type="point"><point name="position" value="5, 0, 0"/></emitter>)";
  const std::string sky = R"(<emitter type="constant"/>)";
  EXPECT_NE(medium_of_start(load(kPoint + fog_ball(1))), nullptr);
  EXPECT_NE(medium_of_start(load(lamp + fog_ball(1))), nullptr);
  EXPECT_EQ(medium_of_start(load(far + fog_ball(1))), nullptr);
  EXPECT_EQ(medium_of_start(load(sky + fog_ball(1))), nullptr);
}

TEST(AdjointCorrection, IsOneForTrueNormalsAndNothingWhereTheyDisagree) {
  SurfacePoint point;
  point.ng = Vec3(0, 0, 1);
  const Vec3 a = normalize(Vec3(0.3f, 0.2f, 0.9f)), b = normalize(Vec3(-0.5f, 0.1f, 0.4f));
  point.shading = Frame(point.ng);
  EXPECT_NEAR(adjoint_correction(point, a, b), 1, 1e-6f);
  EXPECT_NEAR(adjoint_correction(point, a, -b), 1, 1e-6f) << "transmission";
  point.shading = Frame(normalize(Vec3(0.5f, 0, 1)));
  EXPECT_NEAR(adjoint_correction(point, a, b) * adjoint_correction(point, b, a), 1, 1e-5f);
  EXPECT_GT(std::abs(adjoint_correction(point, a, b) - 1), 0.1f);
  const Vec3 between = normalize(Vec3(-1, 0, 0.1f));  // above the surface, below the shading normal's horizon
  EXPECT_EQ(adjoint_correction(point, a, between), 0);
  EXPECT_EQ(adjoint_correction(point, between, a), 0);
}

}  // namespace
}  // namespace turbid
