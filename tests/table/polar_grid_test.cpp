#include "table/polar_grid.h"

#include <gtest/gtest.h>

#include <numbers>

#include "core/rng.h"

namespace turbid {
namespace {

const PolarGrid kGrid(12, 10, 50);

TEST(PolarGrid, CoordinatesAreInverses) {
  for (double cells = 0.25; cells < 10; cells += 0.5) {
    EXPECT_NEAR(static_cast<double>(kGrid.angular(static_cast<float>(kGrid.cosine(cells)))), cells, 2e-3);
    EXPECT_NEAR(static_cast<double>(kGrid.radial(static_cast<float>(kGrid.radius(cells)))), cells, 1e-4);
  }
  EXPECT_NEAR(kGrid.radius(12), 50, 1e-9);
  EXPECT_NEAR(kGrid.cosine(10), -1, 1e-12);
}

// The whole content of cells with r T = 1 is int r dr 4 pi.
TEST(PolarGrid, MeansOfContent) {
  double volume = 0;
  for (int i = 0; i < kGrid.radii(); ++i)
    for (int j = 0; j < kGrid.angles(); ++j) volume += 1 / kGrid.mean_of_content(i, j);
  EXPECT_NEAR(volume, 2 * std::numbers::pi * 50 * 50, 1e-3 * volume);
}

TEST(PolarGrid, NodesHaveTheContentsOfTheCells) {
  Rng rng(3);
  std::vector<float> contents(kGrid.cell_count());
  double sum = 0;
  for (int i = 0; i < kGrid.radii(); ++i)
    for (int j = 0; j < kGrid.angles(); ++j) {
      float& content = contents[kGrid.index(i, j)];
      content = static_cast<float>((0.5 + rng.next_double()) / kGrid.mean_of_content(i, j));
      sum += static_cast<double>(content);
    }
  kGrid.to_nodes(contents);
  EXPECT_NEAR(kGrid.content(contents), sum, 1e-5 * sum);
}

// r T = 2 - t/10 + u, linear between nodes but at the ends of the grid, comes back.
TEST(PolarGrid, LinearFieldsComeBack) {
  constexpr int kSteps = 200;
  const PolarGrid grid(24, 10, 50);
  std::vector<float> contents(grid.cell_count());
  const auto field = [](double u, double t) { return 2 - 0.1 * t + 0.3 * u; };
  for (int i = 0; i < grid.radii(); ++i)
    for (int j = 0; j < grid.angles(); ++j) {
      double content = 0;
      for (int a = 0; a < kSteps; ++a)
        for (int b = 0; b < kSteps; ++b) {
          const double u = i + (a + 0.5) / kSteps, t = j + (b + 0.5) / kSteps;
          const double r0 = grid.radius(i + a * 1.0 / kSteps), r1 = grid.radius(i + (a + 1.0) / kSteps);
          content += field(std::clamp(u, 0.5, grid.radii() - 0.5), std::clamp(t, 0.5, grid.angles() - 0.5)) *
                     (r1 * r1 - r0 * r0) / 2 * 2 * std::numbers::pi *
                     (grid.cosine(j + b * 1.0 / kSteps) - grid.cosine(j + (b + 1.0) / kSteps));
        }
      contents[grid.index(i, j)] = static_cast<float>(content);
    }
  grid.to_nodes(contents);
  for (int i = 0; i < grid.radii(); ++i)
    for (int j = 0; j < grid.angles(); ++j)
      EXPECT_NEAR(static_cast<double>(contents[grid.index(i, j)]), field(i + 0.5, j + 0.5), 2e-3) << i << " " << j;
}

}  // namespace
}  // namespace turbid
