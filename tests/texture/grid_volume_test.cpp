// Grids: storage in bricks, look-ups between and beyond voxels, and bounds that majorants may rely on.
#include "texture/grid_volume.h"

#include <gtest/gtest.h>

#include "core/rng.h"
#include "texture/blackbody.h"
#include "texture/constant_volume.h"

namespace turbid {
namespace {

std::vector<float> noise(size_t n, uint64_t seed) {
  Rng rng(seed);
  std::vector<float> values(n);
  for (float& v : values) v = rng.next_float();
  return values;
}

TEST(GridVoxels, GiveBackWhatWasStored) {
  const Voxel size{19, 8, 11};
  for (const int channels : {1, 3})
    for (const VoxelFormat format : {VoxelFormat::kFloat, VoxelFormat::kHalf}) {
      const std::vector<float> values = noise(19 * 8 * 11 * static_cast<size_t>(channels), 3);
      const GridVoxels grid = GridVoxels::from_dense(size, channels, format, values);
      EXPECT_EQ(grid.bricks(), (Voxel{3, 1, 2}));
      const float tolerance = format == VoxelFormat::kHalf ? 0x1p-12f : 0;
      for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
          for (int x = 0; x < size.x; ++x)
            for (int c = 0; c < kChannels; ++c) {
              const int i = ((z * size.y + y) * size.x + x) * channels + (channels == 3 ? c : 0);
              ASSERT_NEAR(grid.at(x, y, z)[c], values[static_cast<size_t>(i)], tolerance);
            }
    }
}

TEST(GridVoxels, EmptySpaceCostsAlmostNothing) {
  std::vector<float> values(128 * 128 * 128, 0.0f);
  EXPECT_LT(GridVoxels::from_dense({128, 128, 128}, 1, VoxelFormat::kFloat, values).memory(), 17000u);
  values[1234567] = 1;
  const GridVoxels grid = GridVoxels::from_dense({128, 128, 128}, 1, VoxelFormat::kFloat, values);
  EXPECT_LT(grid.memory(), 20000u);
  EXPECT_EQ(grid.at(1234567 % 128, 1234567 / 128 % 128, 1234567 / 16384), Spectrum(1.0f));
}

TEST(GridVoxels, RefuseWhatTheyCannotHold) {
  EXPECT_THROW(GridVoxels({0, 1, 1}, 1, VoxelFormat::kFloat), std::invalid_argument);
  EXPECT_THROW(GridVoxels({1, 1, 1}, 2, VoxelFormat::kFloat), std::invalid_argument);
  EXPECT_THROW(GridVoxels({1 << 30, 1 << 30, 1 << 30}, 1, VoxelFormat::kFloat), std::invalid_argument);
  EXPECT_THROW(GridVoxels({2147483647, 2147483647, 2147483647}, 1, VoxelFormat::kFloat), std::invalid_argument);
  EXPECT_THROW(GridVoxels::from_dense({1, 1, 1}, 1, VoxelFormat::kFloat, std::vector<float>{kInfinity}),
               std::invalid_argument);
  EXPECT_THROW(GridVoxels::from_dense({1, 1, 1}, 1, VoxelFormat::kHalf, std::vector<float>{1e6f}),
               std::invalid_argument);
}

/// Voxel (i, j, k) holds i + 10 j + 100 k.
GridVoxels digits(const Voxel& size) {
  std::vector<float> values;
  for (int k = 0; k < size.z; ++k)
    for (int j = 0; j < size.y; ++j)
      for (int i = 0; i < size.x; ++i) values.push_back(static_cast<float>(i + 10 * j + 100 * k));
  return GridVoxels::from_dense(size, 1, VoxelFormat::kFloat, values);
}

TEST(GridVolume, VoxelsHaveTheirCentresInTheMiddleOfTheirCells) {
  for (const GridFilter filter : {GridFilter::kTrilinear, GridFilter::kNearest}) {
    const GridVolume grid(digits({10, 9, 4}), {.filter = filter});
    for (int i = 0; i < 10; ++i)
      EXPECT_NEAR(grid.eval({(static_cast<float>(i) + 0.5f) / 10, 3.5f / 9, 2.5f / 4})[0], static_cast<float>(i + 230),
                  1e-4f);
  }
}

TEST(GridVolume, TrilinearGridsReproduceLinearFunctions) {
  const GridVolume grid(digits({10, 9, 4}), {});
  Rng rng(1);
  for (int n = 0; n < 200; ++n) {
    const auto between = [&](float cells) { return 0.5f + rng.next_float() * (cells - 1); };
    const float x = between(10), y = between(9), z = between(4);
    EXPECT_NEAR(grid.eval({x / 10, y / 9, z / 4})[0], x - 0.5f + 10 * (y - 0.5f) + 100 * (z - 0.5f), 1e-3f);
  }
}

TEST(GridVolume, WrapsAsAsked) {
  const auto at = [](GridWrap wrap, GridFilter filter, float x) {
    return GridVolume(digits({4, 1, 1}), {.filter = filter, .wrap = wrap}).eval({x / 4, 0.5f, 0.5f})[0];
  };
  using enum GridWrap;
  for (const GridFilter filter : {GridFilter::kTrilinear, GridFilter::kNearest}) {
    EXPECT_EQ(at(kClamp, filter, -0.5f), 0);
    EXPECT_EQ(at(kClamp, filter, 7.5f), 3);
    EXPECT_EQ(at(kRepeat, filter, -0.5f), 3);
    EXPECT_EQ(at(kRepeat, filter, 5.5f), 1);
    EXPECT_EQ(at(kMirror, filter, -1.5f), 1);
    EXPECT_EQ(at(kMirror, filter, 5.5f), 2);
    EXPECT_EQ(at(kMirror, filter, 9.5f), 1);
  }
  EXPECT_FLOAT_EQ(at(kClamp, GridFilter::kTrilinear, 0), 0);
  EXPECT_FLOAT_EQ(at(kRepeat, GridFilter::kTrilinear, 0), 1.5f);
  EXPECT_FLOAT_EQ(at(kMirror, GridFilter::kTrilinear, 4), 3);
}

TEST(GridVolume, FarAwayIsStillDefined) {
  for (const GridWrap wrap : {GridWrap::kClamp, GridWrap::kRepeat, GridWrap::kMirror})
    for (const float far : {1e10f, -1e10f, 1e38f, -1e38f})
      EXPECT_TRUE(GridVolume(digits({4, 3, 2}), {.wrap = wrap}).eval(Vec3(far)).is_finite());
}

TEST(GridVolume, StandsWhereToWorldPutsIt) {
  const Transform to_world =
      Transform::translate(10, 20, 30) * Transform::rotate(0, 0, 1, 90) * Transform::scale(10, 9, 4);
  const GridVolume grid(digits({10, 9, 4}), {.to_world = to_world});
  EXPECT_NEAR(length(grid.bounds().min - Vec3(1, 20, 30)), 0, 1e-4f);
  EXPECT_NEAR(length(grid.bounds().max - Vec3(10, 30, 34)), 0, 1e-4f);
  EXPECT_NEAR(grid.eval({10 - 3.5f, 20 + 7.5f, 30 + 2.5f})[0], 237, 1e-2f);
  EXPECT_NEAR(length(grid.resolution() - Vec3(10, 9, 4)), 0, 1e-3f);
}

/// Boxes of all sizes in and around the grid, and points in them: does a point ever leave the range?
bool ranges_hold(const Volume& volume, const std::function<ValueRange(const Bounds3&)>& range) {
  Rng rng(9);
  const auto point = [&](float reach) {
    return Vec3(rng.next_float(), rng.next_float(), rng.next_float()) * (1 + 2 * reach) - Vec3(reach);
  };
  for (int n = 0; n < 400; ++n) {
    Bounds3 box;
    const Vec3 corner = point(0.4f);
    box.extendBy(corner);
    box.extendBy(corner + (point(0) - Vec3(0.5f)) * (n % 2 ? 1.0f : 0.1f));
    const ValueRange bound = range(box);
    for (int k = 0; k < 100; ++k) {
      const Vec3 u = point(0);
      const Spectrum v = volume.eval(box.min + u * (box.max - box.min));
      for (int c = 0; c < kChannels; ++c)
        if (v[c] > bound.max[c] * 1.00001f || v[c] < bound.min[c] * 0.99999f) return false;
    }
    for (int c = 0; c < kChannels; ++c)
      if (!(bound.mean[c] >= bound.min[c] * 0.9999f && bound.mean[c] <= bound.max[c] * 1.0001f)) return false;
  }
  return true;
}

TEST(GridVolume, RangesBoundTheValues) {
  const GridVoxels voxels = GridVoxels::from_dense({21, 17, 9}, 3, VoxelFormat::kFloat, noise(21 * 17 * 9 * 3, 4));
  for (const GridFilter filter : {GridFilter::kTrilinear, GridFilter::kNearest})
    for (const GridWrap wrap : {GridWrap::kClamp, GridWrap::kRepeat, GridWrap::kMirror})
      for (const Transform& turn : {Transform(), Transform::rotate(1, 2, 3, 40)}) {
        const GridVolume grid(voxels, {.filter = filter, .wrap = wrap, .to_world = turn});
        EXPECT_TRUE(ranges_hold(grid, [&](const Bounds3& box) { return grid.range(box); }));
        // Turned boxes, nearest values and repetition leave some room.
        if (turn.at(0, 0) != 1 || filter != GridFilter::kTrilinear || wrap == GridWrap::kRepeat) continue;
        // Planted: bounds of a box that is smaller by a part of a voxel.
        EXPECT_FALSE(ranges_hold(grid, [&](const Bounds3& box) {
          const Vec3 middle = (box.min + box.max) * 0.5f;
          return grid.range({middle + (box.min - middle) * 0.6f, middle + (box.max - middle) * 0.6f});
        }));
      }
}

TEST(ConstantVolume, IsTheSameEverywhereAndBoundedByTheCube) {
  const ConstantVolume volume({1, 2, 3}, Transform::translate(5, 0, 0) * Transform::scale(2, 3, 4));
  EXPECT_EQ(volume.eval(Vec3(100)), Spectrum(1, 2, 3));
  EXPECT_EQ(volume.range(volume.bounds()).max, Spectrum(1, 2, 3));
  EXPECT_EQ(volume.bounds().min, Vec3(5, 0, 0));
  EXPECT_EQ(volume.bounds().max, Vec3(7, 3, 4));
}

TEST(Blackbody, HasTheColoursAndBrightnessOfPlanck) {
  EXPECT_EQ(blackbody(0), Spectrum(0.0f));
  EXPECT_EQ(blackbody(-5), Spectrum(0.0f));
  const Spectrum candle = blackbody(1500), white = blackbody(6504);
  EXPECT_EQ(candle[2], 0) << "out of the gamut";
  EXPECT_GT(candle[0], 3 * candle[1]);
  // On the Planckian locus at 6504 K, close to D65 but a little more pink.
  EXPECT_NEAR(white[0] / white[1], 1.03f, 0.06f);
  EXPECT_NEAR(white[2] / white[1], 1.0f, 0.06f);
  // Planck's law at 555 nm, which most of the luminance is near to: 4.3e4 W/(sr m^2 nm).
  EXPECT_NEAR(white.luminance() / 4.3e4f, 1, 0.05f);
  const ConstantVolume hot(Spectrum(1500.0f));
  const BlackbodyVolume volume(std::make_shared<ConstantVolume>(hot), 2);
  for (const int c : {0, 1, 2}) EXPECT_NEAR(volume.eval(Vec3(0))[c], 2 * candle[c], 1e-4f * candle[0]);
}

}  // namespace
}  // namespace turbid
