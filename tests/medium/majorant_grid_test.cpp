// The grid of majorants: rays visit the right cells, and no density exceeds its bound.
#include "medium/majorant_grid.h"

#include <gtest/gtest.h>

#include "core/frame.h"
#include "core/rng.h"
#include "core/warp.h"
#include "medium/volumes_for_tests.h"

namespace turbid {
namespace {

using testing::constant_volume;
using testing::make_medium;

MajorantGrid grid_of(const Bounds3& box, const std::array<int, 3>& counts) {
  MajorantGrid grid(box, counts);
  for (int z = 0; z < counts[2]; ++z)
    for (int y = 0; y < counts[1]; ++y)
      for (int x = 0; x < counts[0]; ++x) grid.cell(x, y, z).majorant = static_cast<float>(x + 100 * y + 10000 * z);
  return grid;
}

Vec3 random_point(Rng& rng, const Bounds3& box, float reach) {
  const Vec3 u(rng.next_float(), rng.next_float(), rng.next_float());
  return box.min + (box.max - box.min) * (u * (1 + 2 * reach) - Vec3(reach));
}

TEST(MajorantGrid, RaysVisitTheCellsTheyCross) {
  const Bounds3 box({-1, 2, 0}, {3, 3, 0.5f});
  const MajorantGrid grid = grid_of(box, {8, 3, 5});
  Rng rng(1);
  int visits = 0;
  for (int n = 0; n < 3000; ++n) {
    const Vec3 from = random_point(rng, box, 0.5f), to = random_point(rng, box, 0.5f);
    Vec3 direction = to - from;
    if (n % 5 == 0) direction[static_cast<unsigned>(n / 5 % 3)] = 0;
    const Ray ray{from, normalize(direction), n % 2 ? kInfinity : length(direction) * rng.next_float()};
    const auto part = grid.clip(ray);
    float at = part ? (*part)[0] : 0;
    grid.walk(ray, [&](const MajorantCell& cell, float t0, float t1) {
      EXPECT_EQ(t0, at) << "a gap";
      EXPECT_LT(t0, t1);
      EXPECT_LE(t1, ray.t_max);
      at = t1;
      // The cell's box, widened by a little, holds both ends.
      const int id = static_cast<int>(cell.majorant);
      const Bounds3 around = grid.cell_box(id % 100, id / 100 % 100, id / 10000);
      EXPECT_TRUE(around.intersects(ray.at(t0)) && around.intersects(ray.at(t1))) << n;
      ++visits;
      return true;
    });
    EXPECT_EQ(at, part ? (*part)[1] : 0) << "not to the end";
  }
  EXPECT_GT(visits, 5000);
}

TEST(MajorantGrid, RaysAlongWallsAndCornersAreWalkedToTheEnd) {
  const Bounds3 box(Vec3(0), Vec3(4));
  const MajorantGrid grid = grid_of(box, {4, 4, 4});
  for (const Vec3& direction : {Vec3(1, 0, 0), Vec3(0, -1, 0), Vec3(1, 1, 1), Vec3(1, -1, 0), Vec3(-1, -1, -1)})
    for (const Vec3& through : {Vec3(2), Vec3(1, 2, 3), Vec3(0, 2, 0), Vec3(4, 4, 0), Vec3(2, 2, 0.5f)}) {
      const Vec3 d = normalize(direction);
      const Ray ray{through - d * 10.0f, d};
      const auto part = grid.clip(ray);
      double sum = 0;
      grid.walk(ray, [&](const MajorantCell&, float t0, float t1) {
        sum += static_cast<double>(t1 - t0);
        return true;
      });
      EXPECT_NEAR(sum, part ? static_cast<double>((*part)[1] - (*part)[0]) : 0, 1e-5);
    }
}

TEST(MajorantGrid, MissedBoxesAreNotVisited) {
  const MajorantGrid grid = grid_of({Vec3(0), Vec3(1)}, {2, 2, 2});
  for (const Ray& ray : {Ray{{0.5f, 0.5f, 2}, {0, 0, 1}}, Ray{{0.5f, 0.5f, -2}, {0, 0, 1}, 1.5f},
                         Ray{{2, 0.5f, 0.5f}, {0, 1, 0}}, Ray{{-1, 1.8f, 0.5f}, normalize(Vec3(1, 1, 0))}})
    grid.walk(ray, [](const MajorantCell&, float, float) {
      ADD_FAILURE() << "visited";
      return true;
    });
}

bool bounded(const HeterogeneousMedium& medium, const Volume& density, float planted) {
  Rng rng(3);
  for (int n = 0; n < 4000; ++n) {
    const Ray ray{random_point(rng, medium.bounds(), 0.3f), square_to_sphere({rng.next_float(), rng.next_float()})};
    bool right = true;
    medium.majorants().walk(ray, [&](const MajorantCell& cell, float t0, float t1) {
      for (const float u : {0.0f, rng.next_float(), 1.0f}) {
        const Spectrum v = density.eval(ray.at(t0 + u * (t1 - t0)));
        right = right && v.max() <= cell.majorant * planted * 1.000001f;
        for (int c = 0; c < kChannels; ++c) right = right && v[c] >= cell.minorant[c] * 0.999999f;
      }
      return right;
    });
    if (!right) return false;
  }
  return true;
}

TEST(MajorantGrid, BoundsTheDensityEverywhere) {
  std::vector<float> values(23 * 17 * 30 * 3);
  Rng rng(8);
  for (float& v : values) v = rng.next_float() < 0.3f ? 0 : 5 * rng.next_float();
  for (const GridFilter filter : {GridFilter::kTrilinear, GridFilter::kNearest})
    for (const Transform& to_world : {Transform::scale(2, 2, 2), Transform::rotate(1, 1, 0, 30)}) {
      const auto density =
          std::make_shared<GridVolume>(GridVoxels::from_dense({23, 17, 30}, 3, VoxelFormat::kFloat, values),
                                       GridSettings{.filter = filter, .to_world = to_world});
      const HeterogeneousMedium medium = make_medium(density, constant_volume(Spectrum(0.5f)));
      EXPECT_TRUE(bounded(medium, *density, 1));
      EXPECT_FALSE(bounded(medium, *density, 0.9f)) << "planted: majorants a tenth too low";
    }
}

TEST(MajorantGrid, NeedsAVolume) {
  EXPECT_THROW(MajorantGrid({Vec3(0), Vec3(1, 0, 1)}, {1, 1, 1}), std::invalid_argument);
  EXPECT_THROW(MajorantGrid({Vec3(0), Vec3(1)}, {1, 0, 1}), std::invalid_argument);
}

}  // namespace
}  // namespace turbid
