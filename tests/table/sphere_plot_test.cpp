// Lobes over the whole sphere of directions: where they stand in the picture, and what compression does to them.
#include "table/sphere_plot.h"

#include <gtest/gtest.h>

#include "medium/henyey_greenstein.h"
#include "table/sagittal_view.h"

namespace turbid::testing {
namespace {

/// The same lobe e^(3 cos - 3) everywhere, wider by `spread` across the sagittal plane (y), about an axis at some angle
/// to the line from the source.
class SameLobe final : public LightField {
 public:
  SameLobe(float angle, float spread, float largest = 1) : angle_(angle), spread_(spread), largest_(largest) {}
  float eval(const Vec3& x, const Vec3& axis, const Vec3& w) const override {
    const SagittalView view(x, axis, w);
    const Vec3& d = view.direction;
    return largest_ * std::exp(3 * (d.x * std::sin(angle_) + d.z * std::cos(angle_) - 1) + spread_ * d.y * d.y);
  }
  float density(const Vec3&, const Vec3&) const override { return 1; }

 private:
  float angle_, spread_, largest_;
};

const Quadtree::Place kPlace{2, 3};

TEST(SpherePlot, CompressionLosesWhatIsNotEvenAboutAnAxis) {
  const SameLobe even(0.6f, 0), wide(0.6f, 1.5f);
  for (const SourceKind kind : {SourceKind::kCollision, SourceKind::kRay}) {
    EXPECT_LT(compression_error(even, kPlace, kind), 0.02);
    EXPECT_GT(compression_error(wide, kPlace, kind), 0.04);
  }
  // Segments have a coronal section.
  EXPECT_LT(compression_error(wide, kPlace, SourceKind::kRay),
            0.6 * compression_error(wide, kPlace, SourceKind::kCollision));
  EXPECT_EQ(compression_error(SameLobe(0, 0, 0), kPlace, SourceKind::kCollision), 0) << "a lobe of nothing";
}

float channel_at(const Image& image, int c, int x, int y) {
  return image.channel(static_cast<size_t>(c))[static_cast<size_t>(y * image.width() + x)];
}

/// Columns about the middle of the first disk, by their light.
double mean_column(const Image& image, int disk) {
  double sum = 0, moment = 0;
  for (int y = 8; y < 8 + disk; ++y)
    for (int x = 8; x < 8 + disk; ++x) {
      const auto light = static_cast<double>(channel_at(image, 0, x, y) + channel_at(image, 1, x, y));
      sum += light;
      moment += light * (x + 0.5 - 8 - disk / 2.0);
    }
  return moment / sum;
}

TEST(SpherePlot, ShowsLobesAlongTheOptimalAxis) {
  constexpr int kDisk = 100, kStep = kDisk + 8;
  const auto table = std::make_shared<QuadtreeTable>(
      build_quadtree_table(HenyeyGreensteinPhase(0.7f), Spectrum(0.8f), {1, 20'000}, {.leaves = 300}));
  const QuadtreeField sampled(table, SourceKind::kCollision, 0);
  const float axis = sampled.optimal_axis(kPlace);
  ASSERT_GT(std::abs(axis), 0.05f);
  const auto plot = [&](const LightField& computed) { return plot_spheres(computed, sampled, {kPlace}, kDisk); };
  const Image image = plot(SameLobe(axis, 0));
  EXPECT_EQ(image.width(), 3 * kStep + 8);
  EXPECT_EQ(image.height(), kStep + 8);
  // The lobe is in the middle; turned, it moves to the side to which angles grow.
  EXPECT_NEAR(mean_column(image, kDisk), 0, 0.5);
  EXPECT_GT(mean_column(plot(SameLobe(axis + 0.4f, 0)), kDisk), 2);
  EXPECT_LT(mean_column(plot(SameLobe(axis - 0.4f, 0)), kDisk), -2);
  EXPECT_GT(channel_at(image, 2, 8 + kDisk / 2, 8 + kDisk / 2), 0.9f) << "white where the lobe is largest";
  EXPECT_EQ(channel_at(image, 0, 9, 9), 0) << "black beyond the rim";
  // A field against itself has one set of isolines: none is green.
  const auto green_lines = [&](const Image& of) {
    int count = 0;
    for (int y = 8; y < 8 + kDisk; ++y)
      for (int x = 8 + 2 * kStep; x < 8 + 2 * kStep + kDisk; ++x)
        count += channel_at(of, 1, x, y) > 0.5f && channel_at(of, 2, x, y) < 0.5f;
    return count;
  };
  EXPECT_EQ(green_lines(plot(sampled)), 0);
  EXPECT_GT(green_lines(plot(SameLobe(axis + 0.4f, 0, sampled.eval({2, 0, 3}, {0, 0, 1}, {0.4f, 0, 0.9f})))), 100);
}

}  // namespace
}  // namespace turbid::testing
