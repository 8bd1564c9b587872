#include "integrator/path_tracer.h"

#include <gtest/gtest.h>

#include "integrator/plain_tracer.h"
#include "integrator/rendering.h"

namespace turbid::testing {
namespace {

/// A ball with a medium, seen from the front; `content` adds what the test is about.
std::string ball_scene(const std::string& content, const std::string& integrator = R"(<integrator type="volpath"/>)") {
  return R"(<scene version="3.0.0">)" + integrator + R"(
  <sensor type="perspective">
    <float name="fov" value="39.3"/>
    <transform name="to_world"><lookat origin="0,0.5,4" target="0,0,0" up="0,1,0"/></transform>
    <film type="hdrfilm"><integer name="width" value="24"/><integer name="height" value="24"/><rfilter type="box"/></film>
  </sensor>)" +
         content + "</scene>";
}

const std::string kSky = R"(<emitter type="constant"><rgb name="radiance" value="1"/></emitter>)";
const std::string kLamp = R"(
  <shape type="sphere"><float name="radius" value="0.5"/><point name="center" value="2,3,1"/>
    <emitter type="area"><rgb name="radiance" value="20"/></emitter></shape>)";

std::string ball(const std::string& bsdf, const std::string& medium) {
  return R"(<shape type="sphere">)" + bsdf + R"(<medium name="interior" type="homogeneous">)" + medium +
         R"(</medium></shape>)";
}

const std::string kGlass =
    R"(<bsdf type="dielectric"><float name="int_ior" value="1.33"/><float name="ext_ior" value="1"/></bsdf>)";
const std::string kWaxBoundary =
    R"(<bsdf type="dielectric"><float name="int_ior" value="1.446"/><float name="ext_ior" value="1"/></bsdf>)";
const std::string kNull = R"(<bsdf type="null"/>)";
const std::string kClear =
    R"(<rgb name="sigma_s" value="0.495, 0.35, 0.495"/><rgb name="sigma_a" value="0.005, 0.15, 0.005"/>)";
const std::string kWax =
    R"(<rgb name="sigma_s" value="15.07, 15.27, 12.7"/><rgb name="sigma_a" value="0.307, 0.603, 4.237"/>
  <phase type="hg"><float name="g" value="0.8"/></phase>)";
const std::string kChromatic = R"(<rgb name="sigma_t" value="10, 2, 5"/><rgb name="albedo" value="0.5, 0.5, 0.99"/>
  <phase type="hg"><float name="g" value="-0.4"/></phase>)";

struct TwinCase {
  const char* name;
  std::string content;
  uint32_t samples;
};

/// `volpath` against its plain twin: equal means; and, at equal sample counts, no more variance than the twin has.
void expect_twins_agree(const TwinCase& test, uint32_t times) {
  LoadedScene loaded = load_scene_from_string(ball_scene(test.content), "twin scene");
  const IntegratorSetup setup = make_integrator(loaded.integrator);
  const Scene scene(std::move(loaded.parts));
  PlainTracer plain;
  const ImageMean fast = mean_of(render_with(scene, *setup.integrator, times * test.samples, 1));
  const ImageMean slow = mean_of(render_with(scene, plain, times * test.samples, 2));
  for (int c = 0; c < kChannels; ++c)
    EXPECT_LT(z_score(fast.mean[c], fast.error[c], slow.mean[c], slow.error[c]), 3.5)
        << "channel " << c << ": " << fast.mean[c] << " against " << slow.mean[c];
  EXPECT_LT(fast.variance, 1.03 * slow.variance);
}

std::vector<TwinCase> twin_cases() {
  const std::string lamp_inside = R"(<shape type="sphere"><float name="radius" value="0.3"/>
    <emitter type="area"><rgb name="radiance" value="5"/></emitter></shape>)";
  return {{"clear_sphere", kSky + ball(kGlass, kClear), 1000},
          {"wax_sphere", kLamp + ball(kWaxBoundary, kWax), 1500},
          {"chromatic_null", kSky + kLamp + ball(kNull, kChromatic), 1000},
          {"chromatic_glass", kSky + ball(kGlass, kChromatic), 3000},
          {"light_inside", ball(kNull, kClear) + lamp_inside, 1000},
          {"light_inside_glass", ball(kGlass, kChromatic) + lamp_inside, 1000}};
}

std::string name_of(const ::testing::TestParamInfo<TwinCase>& instance) { return instance.param.name; }

class Twins : public ::testing::TestWithParam<TwinCase> {};
TEST_P(Twins, AgreeAndTheFastOneIsNotNoisier) { expect_twins_agree(GetParam(), 1); }
INSTANTIATE_TEST_SUITE_P(Scenes, Twins, ::testing::ValuesIn(twin_cases()), name_of);

class TwinsAtLength : public ::testing::TestWithParam<TwinCase> {};
TEST_P(TwinsAtLength, AgreeAndTheFastOneIsNotNoisier) { expect_twins_agree(GetParam(), 30); }
INSTANTIATE_TEST_SUITE_P(Slow, TwinsAtLength, ::testing::ValuesIn(twin_cases()), name_of);

// The harness must notice a light that is 3 % too bright.
TEST(TwinsHarness, NoticesAPlantedError) {
  const ImageMean right = mean_of(render_text(ball_scene(kSky + ball(kGlass, kClear)), 1000));
  const std::string brighter = R"(<emitter type="constant"><rgb name="radiance" value="1.03"/></emitter>)";
  const ImageMean wrong = mean_of(render_text(ball_scene(brighter + ball(kGlass, kClear)), 1000, {}, 2));
  EXPECT_GT(z_score(right.mean[0], right.error[0], wrong.mean[0], wrong.error[0]), 3.5);
}

TEST(PathTracer, CameraInTheCentreOfAnAbsorbingSphereSeesTheSkyThroughIt) {
  const std::string scene = R"(<scene version="3.0.0"><integrator type="volpath"/>
    <sensor type="perspective"><float name="fov" value="60"/><float name="near_clip" value="0.0001"/>
      <film type="hdrfilm"><integer name="width" value="8"/><integer name="height" value="8"/><rfilter type="box"/></film>
    </sensor>)" + kSky + ball("$", R"(<rgb name="sigma_a" value="0.5, 1, 2"/><rgb name="sigma_s" value="0"/>)") +
                            "</scene>";
  for (const std::string& boundary : {kNull, R"(<bsdf type="dielectric"><float name="int_ior" value="1"/>
                                       <float name="ext_ior" value="1"/></bsdf>)" +
                                                 std::string()}) {
    std::string with_boundary = scene;
    with_boundary.replace(with_boundary.find('$'), 1, boundary);
    const ImageMean mean = mean_of(render_text(with_boundary, 4));
    EXPECT_NEAR(mean.mean[0], std::exp(-0.5), 1e-4);
    EXPECT_NEAR(mean.mean[1], std::exp(-1.0), 1e-4);
    EXPECT_NEAR(mean.mean[2], std::exp(-2.0), 1e-4);
  }
}

// No light leaks through a boundary: inside a closed shell nothing of a bright sky is seen, however often light
// bounces.
TEST(PathTracer, ClosedShellsLetNoLightIn) {
  const std::string sky = R"(<emitter type="constant"><rgb name="radiance" value="1000"/></emitter>)";
  const std::string fog = R"(<medium name="interior" type="homogeneous"><rgb name="sigma_t" value="2"/>
    <rgb name="albedo" value="0.95"/></medium><bsdf type="diffuse"><rgb name="reflectance" value="0.9"/></bsdf>)";
  const std::string shells[] = {
      R"(<shape type="sphere"><float name="radius" value="9"/>)", R"(<shape type="cube">
         <transform name="to_world"><rotate x="1" y="2" z="3" angle="37"/><scale value="9"/></transform>)",
      R"(<shape type="generated"><string name="kind" value="bumpy_sphere"/><float name="radius" value="9"/>
         <float name="amplitude" value="0.2"/><float name="frequency" value="5"/><integer name="subdivisions" value="5"/>)",
      R"(<shape type="generated"><string name="kind" value="torus"/><float name="major_radius" value="4"/>
         <float name="minor_radius" value="1.5"/>)"};
  for (const std::string& shell : shells) {
    const Film film = render_text(ball_scene(sky + shell + fog + "</shape>"), 400);
    EXPECT_EQ(mean_of(film).grey(), 0) << shell;
  }
}

TEST(PathTracer, ScatteringOrdersAddUpToTheFullImage) {
  const std::string content = kSky + kLamp + ball(kNull, kChromatic);
  const auto render_orders = [&](const std::string& limits) {
    return render_text(ball_scene(content, R"(<integrator type="volpath"><integer name="max_depth" value="12"/>)" +
                                               limits + "</integrator>"),
                       64);
  };
  const Film full = render_orders("");
  Film sum(full.size());
  for (int order = 0; order < 12; ++order) {
    const std::string k = std::to_string(order);
    sum.add(render_orders(R"(<integer name="min_scattering" value=")" + k +
                          R"("/><integer name="max_scattering" value=")" + k + R"("/>)"));
  }
  for (size_t i = 0; i < full.pixel_count(); ++i)
    for (int c = 0; c < kChannels; ++c)
      EXPECT_NEAR(sum.pixel(i).radiance[c], full.pixel(i).radiance[c], 1e-4 * (1 + full.pixel(i).radiance[c]));
}

TEST(PathTracer, NullBoundariesCostNoDepth) {
  // Three nested empty shells in front of the sky: one edge is enough to see it.
  std::string shells;
  for (const char* radius : {"0.3", "0.6", "0.9"})
    shells += R"(<shape type="sphere"><float name="radius" value=")" + std::string(radius) +
              R"("/><bsdf type="null"/></shape>)";
  const ImageMean mean = mean_of(render_text(
      ball_scene(kSky + shells, R"(<integrator type="volpath"><integer name="max_depth" value="1"/></integrator>)"),
      4));
  EXPECT_NEAR(mean.grey(), 1, 1e-12);
}

TEST(PathTracer, SingleScatteringOfAPointLightMatchesQuadrature) {
  // Camera and light inside one large sphere of fog: L = int sigma_s f I exp(-sigma_t (t + d)) / d^2 dt along each ray.
  const std::string scene = R"(<scene version="3.0.0">
    <integrator type="volpath"><integer name="max_scattering" value="1"/><integer name="min_scattering" value="1"/></integrator>
    <sensor type="perspective"><float name="fov" value="1"/><float name="near_clip" value="0.0001"/>
      <film type="hdrfilm"><integer name="width" value="4"/><integer name="height" value="4"/><rfilter type="box"/></film>
    </sensor>
    <emitter type="point"><point name="position" value="0.5,0,2"/><rgb name="intensity" value="3"/></emitter>
    <shape type="sphere"><float name="radius" value="100"/><bsdf type="null"/>
      <medium name="interior" type="homogeneous"><rgb name="sigma_a" value="0.1"/><rgb name="sigma_s" value="0.4"/>
        <phase type="hg"><float name="g" value="0.6"/></phase></medium></shape></scene>)";
  const double sigma_t = 0.5, sigma_s = 0.4, g = 0.6, intensity = 3;
  double expected = 0;
  const double dt = 1e-4;
  for (double t = dt / 2; t < 60; t += dt) {
    const double z = 2 - t, d2 = 0.25 + z * z, d = std::sqrt(d2);
    const double deflection = z / d;  // between the light's way to the ray and the ray's way back to the camera
    const double f = (1 - g * g) / (4 * M_PI * std::pow(1 + g * g - 2 * g * deflection, 1.5));
    expected += sigma_s * f * intensity * std::exp(-sigma_t * (t + d)) / d2 * dt;
  }
  const ImageMean mean = mean_of(render_text(scene, 100000));
  EXPECT_LT(z_score(mean.grey(), mean.grey_error(), expected), 3.5) << mean.grey() << " against " << expected;
  EXPECT_LT(mean.grey_error(), 0.005 * expected);
}

/// Samples that were not finite.
uint64_t dropped_samples(const std::string& xml, uint32_t samples) {
  LoadedScene loaded = load_scene_from_string(xml, "test scene");
  const IntegratorSetup setup = make_integrator(loaded.integrator);
  render_with(Scene(std::move(loaded.parts)), *setup.integrator, samples);
  return setup.integrator->counters().at("dropped_samples");
}

std::string colored_ball(const std::string& center, const std::string& color) {
  return R"(<shape type="sphere"><point name="center" value=")" + center +
         R"("/><bsdf type="diffuse"><rgb name="reflectance" value=")" + color + R"("/></bsdf></shape>)";
}

TEST(PathTracer, ColorsThatShareNoChannelDropNoSample) {
  // What red has reflected is black on blue: the light that is asked for there goes through fog with no throughput.
  const std::string fog =
      R"(<shape type="sphere"><float name="radius" value="9"/>)" + kNull +
      R"(<medium name="interior" type="homogeneous"><rgb name="sigma_t" value="0.05"/></medium></shape>)";
  const std::string pane = R"(<shape type="sphere"><float name="radius" value="5"/><bsdf type="thindielectric">
    <rgb name="specular_transmittance" value="0, 1, 0"/></bsdf></shape>)";
  const std::string balls = colored_ball("-1, 0, 0", "1, 0, 0") + colored_ball("1, 0, 0", "0, 0, 1");
  EXPECT_EQ(dropped_samples(ball_scene(kLamp + balls + fog), 64), 0u);
  EXPECT_EQ(dropped_samples(ball_scene(kSky + balls + pane + fog), 64), 0u);
}

TEST(PathTracer, WhatAbsorbsAllLightDropsNoSample) {
  // Nothing is left behind the first ball; the walk goes on through others, for alpha.
  const auto soot = [](const std::string& z, const std::string& sigma_t) {
    return R"(<shape type="sphere"><point name="center" value="0, 0, )" + z + R"("/>)" + kNull +
           R"(<medium name="interior" type="homogeneous"><rgb name="sigma_t" value=")" + sigma_t +
           R"("/><rgb name="albedo" value="0"/></medium></shape>)";
  };
  const std::string fog = R"(<shape type="sphere"><point name="center" value="0, 0, -5"/>)" + kNull +
                          R"(<medium name="interior" type="homogeneous">)" + kChromatic + "</medium></shape>";
  EXPECT_EQ(dropped_samples(ball_scene(kSky + soot("0", "500") + soot("-2.5", "500") + fog), 16), 0u);
  const std::string floor = R"(<shape type="rectangle"><transform name="to_world"><rotate x="1" angle="-90"/>
    <scale value="9"/><translate y="-1"/></transform></shape>)";
  EXPECT_EQ(dropped_samples(ball_scene(kSky + soot("0", "500") + soot("-2.5", "500") + floor), 64), 0u);
}

TEST(PathTracer, AlphaCountsSurfacesThatReflectNothing) {
  // A diffuse surface is black from behind, and yet there. (One pixel in front of it, seen in its middle.)
  const auto alpha = [](const std::string& content, const std::string& integrator) {
    const Film film = render_text(ball_scene(content, "<integrator type=\"" + integrator + "\"/>"), 4);
    return film.pixel(12 * 24 + 12).alpha / static_cast<double>(film.samples());
  };
  const auto rectangle = [](const std::string& angle) {
    return R"(<shape type="rectangle"><transform name="to_world"><rotate y="1" angle=")" + angle +
           R"("/></transform></shape>)";
  };
  for (const char* integrator : {"path", "volpath"}) {
    EXPECT_EQ(alpha(rectangle("0"), integrator), 1) << integrator;
    EXPECT_EQ(alpha(rectangle("180"), integrator), 1) << integrator;
    EXPECT_EQ(alpha("", integrator), 0) << integrator;
  }
  EXPECT_EQ(alpha(R"(<shape type="sphere">)" + kNull + "</shape>", "volpath"), 0);
}

TEST(PathTracer, SobolAndIndependentSamplesAgree) {
  const std::string content = kSky + kLamp + ball(kNull, kChromatic);
  const auto with_sampler = [&](const std::string& type) {
    std::string scene = ball_scene(content);
    scene.insert(scene.find("<film"), R"(<sampler type=")" + type + R"("/>)");
    return mean_of(render_text(scene, 1024));
  };
  const ImageMean independent = with_sampler("independent"), sobol = with_sampler("sobol");
  for (int c = 0; c < kChannels; ++c)
    EXPECT_LT(z_score(independent.mean[c], independent.error[c], sobol.mean[c], sobol.error[c]), 3.5);
}

}  // namespace
}  // namespace turbid::testing
