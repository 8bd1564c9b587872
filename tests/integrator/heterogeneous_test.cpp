// Paths through heterogeneous media: closed forms, and homogeneous media as the special case that they contain.
#include <gtest/gtest.h>

#include <fstream>

#include "integrator/rendering.h"
#include "testing/temporary_folder.h"
#include "texture/blackbody.h"

namespace turbid::testing {
namespace {

/// Writes an 8 x 8 x 8 grid of 3 channels whose values are strewn over [low, high], different in each channel.
std::string write_grid(const TemporaryFolder& folder, float low, float high) {
  std::ofstream file(folder.file("grid.vol"), std::ios::binary);
  const int32_t header[] = {1, 8, 8, 8, 3};
  const float box[] = {0, 0, 0, 1, 1, 1};
  file.write("VOL\3", 4);
  file.write(reinterpret_cast<const char*>(header), sizeof(header));
  file.write(reinterpret_cast<const char*>(box), sizeof(box));
  Rng rng(12);
  for (int i = 0; i < 8 * 8 * 8 * 3; ++i) {
    const float v = low + (high - low) * rng.next_float() * rng.next_float();
    file.write(reinterpret_cast<const char*>(&v), sizeof(v));
  }
  return folder.file("grid.vol");
}

/// A cube of edge 2 around the origin behind an invisible boundary, seen from the front.
std::string cube_scene(const std::string& medium, const std::string& lights,
                       const std::string& integrator = R"(<integrator type="volpath"/>)") {
  return R"(<scene version="3.0.0">)" + integrator + R"(
  <sensor type="perspective">
    <float name="fov" value="35"/>
    <transform name="to_world"><lookat origin="0,0.7,4" target="0,0,0" up="0,1,0"/></transform>
    <film type="hdrfilm"><integer name="width" value="16"/><integer name="height" value="16"/><rfilter type="box"/></film>
  </sensor>
  <shape type="cube"><bsdf type="null"/>)" +
         medium + "</shape>" + lights + "</scene>";
}

const std::string kToCube = R"(<transform name="to_world"><scale value="2"/><translate value="-1 -1 -1"/></transform>)";
const std::string kSky = R"(<emitter type="constant"><rgb name="radiance" value="1"/></emitter>)";
const std::string kLamp = R"(
  <shape type="sphere"><float name="radius" value="0.7"/><point name="center" value="1.5,2.2,1"/>
    <emitter type="area"><rgb name="radiance" value="20"/></emitter></shape>)";

std::string heterogeneous(const std::string& sigma_t, const std::string& rest) {
  return R"(<medium name="interior" type="heterogeneous">)" + sigma_t + rest + "</medium>";
}
std::string grid(const std::string& path) {
  return R"(<volume name="sigma_t" type="gridvolume"><string name="filename" value=")" + path + R"("/>)" + kToCube +
         "</volume>";
}
std::string constant(const std::string& rgb) {
  return R"(<volume name="sigma_t" type="constvolume"><rgb name="value" value=")" + rgb + R"("/>)" + kToCube +
         "</volume>";
}

void expect_equal(const ImageMean& a, const ImageMean& b) {
  for (int c = 0; c < kChannels; ++c)
    EXPECT_LT(z_score(a.mean[c], a.error[c], b.mean[c], b.error[c]), 3.9)
        << "channel " << c << ": " << a.mean[c] << " against " << b.mean[c];
}

// Where nothing is absorbed, a uniform sky stays what it is. Weights of next-event estimation and of arriving at the
// sky must then add up to 1 on every path, or this is off.
TEST(HeterogeneousPaths, KeepAUniformSkyInAWhiteFurnace) {
  const TemporaryFolder folder;
  const std::string path = write_grid(folder, 0, 8);
  const ImageMean mean =
      mean_of(render_text(cube_scene(heterogeneous(grid(path), R"(<rgb name="albedo" value="1"/>)"), kSky), 400));
  for (int c = 0; c < kChannels; ++c) {
    EXPECT_LT(z_score(mean.mean[c], mean.error[c], 1), 3.9) << mean.mean[c];
    EXPECT_LT(mean.error[c], 0.01);
  }
}

TEST(HeterogeneousPaths, AgreeWithAHomogeneousMedium) {
  const std::string albedo = R"(<rgb name="albedo" value="0.9 0.5 0.99"/>)";
  const ImageMean slow = mean_of(render_text(cube_scene(heterogeneous(constant("1 3 6"), albedo), kSky + kLamp), 300));
  const ImageMean fast = mean_of(render_text(
      cube_scene(
          R"(<medium name="interior" type="homogeneous"><rgb name="sigma_t" value="1 3 6"/>)" + albedo + "</medium>",
          kSky + kLamp),
      500, {}, 2));
  expect_equal(slow, fast);
  const ImageMean other =
      mean_of(render_text(cube_scene(heterogeneous(constant("1.3 3.5 6"), albedo), kSky + kLamp), 300));
  EXPECT_GT(z_score(other.mean[0], other.error[0], fast.mean[0], fast.error[0]), 3.9) << "planted";
}

// An invisible wall through the medium cuts every passage in two and changes no expectation.
TEST(HeterogeneousPaths, DoNotSeeAnInvisibleWall) {
  const TemporaryFolder folder;
  const std::string path = write_grid(folder, 0, 6);
  const std::string medium = heterogeneous(grid(path), R"(<rgb name="albedo" value="0.8 0.6 0.9"/>)");
  const std::string wall = R"(<shape type="rectangle"><transform name="to_world"><scale value="0.999"/>
      <rotate x="1" angle="20"/></transform><bsdf type="null"/></shape>)";
  expect_equal(mean_of(render_text(cube_scene(medium, kLamp), 400)),
               mean_of(render_text(cube_scene(medium, kLamp + wall), 400, {}, 2)));
}

// --- Emission
// ---------------------------------------------------------------------------------------------------------

const std::string kDark = R"(<rgb name="albedo" value="0"/>)";

/// Looks along x through the cube.
std::string through_scene(const std::string& medium, const std::string& integrator) {
  return R"(<scene version="3.0.0">)" + integrator + R"(
  <sensor type="orthographic">
    <transform name="to_world"><scale x="0.5" y="0.5"/><lookat origin="-4,0,0" target="0,0,0" up="0,1,0"/></transform>
    <film type="hdrfilm"><integer name="width" value="8"/><integer name="height" value="8"/><rfilter type="box"/></film>
  </sensor>
  <shape type="cube"><bsdf type="null"/>)" +
         medium + "</shape></scene>";
}

TEST(HeterogeneousPaths, SeeTheGlowOfAUniformMedium) {
  const std::string medium = heterogeneous(constant("0.5 1 3"), kDark + R"(<rgb name="emission" value="2 1 4"/>)");
  const ImageMean mean = mean_of(render_text(through_scene(medium, R"(<integrator type="volpath"/>)"), 2000));
  const double sigma[] = {0.5, 1, 3}, emission[] = {2, 1, 4};
  for (int c = 0; c < kChannels; ++c) {
    const double expected = emission[c] * (1 - std::exp(-2 * sigma[c])) / sigma[c];
    EXPECT_LT(z_score(mean.mean[c], mean.error[c], expected), 3.9) << mean.mean[c] << " for " << expected;
  }
}

TEST(HeterogeneousPaths, GlowCountsAsAnEmitter) {
  const std::string medium = heterogeneous(constant("0.5 1 3"), kDark + R"(<rgb name="emission" value="2 1 4"/>)");
  const auto grey = [&](const std::string& parameter) {
    return mean_of(
               render_text(through_scene(medium, R"(<integrator type="volpath">)" + parameter + "</integrator>"), 50))
        .grey();
  };
  EXPECT_EQ(grey(R"(<boolean name="hide_emitters" value="true"/>)"), 0);
  EXPECT_EQ(grey(R"(<integer name="max_depth" value="0"/>)"), 0);
  EXPECT_GT(grey(R"(<integer name="max_depth" value="1"/>)"), 1);
}

// Matter of one temperature radiates as a black body where it is thick, whatever its extinction.
TEST(HeterogeneousPaths, ThickMatterOfOneTemperatureIsBlack) {
  const std::string medium =
      heterogeneous(constant("20 30 40"),
                    kDark + R"(<float name="temperature" value="3000"/><float name="emission_scale" value="0.01"/>)");
  const ImageMean mean = mean_of(render_text(through_scene(medium, R"(<integrator type="volpath"/>)"), 500));
  const std::string half = heterogeneous(
      constant("20 30 40"),
      R"(<rgb name="albedo" value="0.3"/><float name="temperature" value="3000"/><float name="emission_scale" value="0.01"/>)");
  const Spectrum black = blackbody(3000) * 0.01f;
  for (int c = 0; c < kChannels; ++c) {  // the channel that meets every collision has no noise at all
    const auto expected = static_cast<double>(black[c]);
    EXPECT_NEAR(mean.mean[c], expected, 3.9 * mean.error[c] + 1e-5 * expected);
  }
  // What scatters reflects a dark surrounding instead.
  EXPECT_LT(mean_of(render_text(through_scene(half, R"(<integrator type="volpath"/>)"), 100)).grey(),
            0.97 * mean.grey());
}

}  // namespace
}  // namespace turbid::testing
