#include "photon/default_radii.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <numbers>

#include "scene/loader.h"

namespace turbid {
namespace {

constexpr double kHalfPicture = 1;  ///< of what the sensor sees
constexpr float kPixels = 0.5f;
constexpr int kWidth = 4;

/// A square, seen straight from above; `before` stands before it.
Scene square(double half, const std::string& before = "") {
  const std::string xml = fmt::format(
      R"(<scene version="3.0.0"><integrator type="upbp"/>
  <sensor type="orthographic"><transform name="to_world"><scale x="{0}" y="{0}" z="1"/>
  <lookat origin="0, 0, 5" target="0, 0, 0" up="0, 1, 0"/></transform>
  <film type="hdrfilm"><integer name="width" value="{1}"/><integer name="height" value="{1}"/></film></sensor>
  <emitter type="constant"/>
  <shape type="rectangle"><transform name="to_world"><scale x="{2}" y="{2}" z="1"/></transform>
  <bsdf type="diffuse"/></shape>{3}</scene>)",
      kHalfPicture, kWidth, half, before);
  return Scene(std::move(load_scene_from_string(xml, "square", {}).parts));
}

std::string pane(const std::string& bsdf) {
  return fmt::format(R"(<shape type="rectangle"><transform name="to_world"><scale x="9" y="9" z="1"/>
  <translate z="2"/></transform><bsdf type="{}"/></shape>)",
                     bsdf);
}

TEST(DefaultRadii, OnSurfacesThatFillThePictureAreByPixels) {
  EXPECT_NEAR(default_surface_radius(square(4), kPixels), kPixels * 2 * kHalfPicture / kWidth, 1e-5);
}

/// By pixels in thin media; in dense ones in proportion to the mean free path. Where flights have no closed form the
/// densest place decides.
TEST(DefaultRadii, InDenseMediaFollowTheMeanFreePath) {
  const KernelRadii radii = default_media_radii(square(4), kPixels);
  const float by_pixels = kPixels * 2 * static_cast<float>(kHalfPicture) / kWidth;
  EXPECT_NEAR(radii.point_beam, by_pixels, 1e-5);
  EXPECT_NEAR(radii.inhomogeneous, by_pixels, 1e-5);
  const PhotonCounts one{1, 1};
  const StrategyWeights weights(StrategyWeights::Heuristic::kBalance, merging_by(radii, one));
  EXPECT_NEAR(static_cast<double>(radii.beam_beam) * weights.kernel_scale(30), 0.015 / 30, 1e-6);
  EXPECT_EQ(weights.kernel_scale(0.01), 1);
}

/// Of disks around the points of a square of side a, 4 x 2 R / (3 pi a) lie outside: 2 R / (3 pi) is the mean of the
/// positive part of a coordinate over a disk.
TEST(DefaultRadii, LoseHalfAPercentAtEdges) {
  const double most = 0.005 * 3 * std::numbers::pi * 2 * kHalfPicture / 8;
  for (const std::string& before : {std::string(), pane("dielectric"), pane("null")}) {
    const double radius = static_cast<double>(default_surface_radius(square(kHalfPicture, before), kPixels));
    // Found in steps of 0.8, with 16 rays for each disk, whose mean is 6 % less.
    EXPECT_LT(radius, 1.12 * most) << before;
    EXPECT_GT(radius, 0.75 * most) << before;
  }
}

}  // namespace
}  // namespace turbid
