// The images by which tables are corrected for boundaries: their weights and places have closed forms.
#include "integrator/boundary_images.h"

#include <gtest/gtest.h>

namespace turbid::testing {
namespace {

const Stretch kLight{Vec3(0.3f, -0.2f, -1.5f), Vec3(0.6f, 0, -0.8f), 2};
const BoundaryPlane kPlane{Vec3(0, 0, 0.5f), Vec3(0, 0, 1), 0.7f};

/// Of a boundary that lets all light out: the source and its image are worth 1 each, the line of negative images -2,
/// int 2 exp(-s / e) / e ds, and lies at e behind the image on average.
TEST(BoundaryImages, HaveTheMomentsOfTheLineOfImages) {
  double sum = 0, negative = 0, moment = 0, second = 0;
  const float mirrored = 2 * kPlane.point.z - kLight.origin.z;
  for (const WeightedStretch& image : with_images(kLight, kPlane)) {
    sum += static_cast<double>(image.weight);
    EXPECT_EQ(image.stretch.length, kLight.length);
    if (image.weight > 0) continue;
    const double behind = static_cast<double>(image.stretch.origin.z - mirrored);
    negative += static_cast<double>(image.weight);
    moment += static_cast<double>(image.weight) * behind;
    second += static_cast<double>(image.weight) * behind * behind;
  }
  const auto e = static_cast<double>(kPlane.extrapolation);
  EXPECT_NEAR(sum, 0, 1e-6);
  EXPECT_NEAR(negative, -2, 1e-6);
  EXPECT_NEAR(moment, -2 * e, 1e-5);
  EXPECT_NEAR(second, -4 * e * e, 1e-5);
}

TEST(BoundaryImages, AreMirroredAtThePlane) {
  const auto images = with_images(kLight, kPlane);
  EXPECT_EQ(images[0].stretch.origin, kLight.origin);
  EXPECT_EQ(images[0].weight, 1);
  EXPECT_NEAR(images[1].stretch.origin.z, 2.5f, 1e-6f);
  EXPECT_NEAR(images[1].stretch.origin.x, kLight.origin.x, 1e-6f);
  EXPECT_NEAR(images[1].stretch.direction.z, 0.8f, 1e-6f);
  EXPECT_NEAR(images[1].stretch.direction.x, 0.6f, 1e-6f);
}

}  // namespace
}  // namespace turbid::testing
