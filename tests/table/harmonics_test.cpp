#include <gtest/gtest.h>

#include <numbers>

#include "core/gauss_legendre.h"
#include "core/rng.h"
#include "core/warp.h"
#include "table/sagittal_harmonics.h"
#include "table/sagittal_view.h"

namespace turbid {
namespace {

constexpr int kDegree = SagittalHarmonics::kMaxDegree;
constexpr size_t kOrders = SagittalHarmonics::kOrders;

std::vector<double> values(const Vec3& w) {
  std::vector<double> result;
  SagittalHarmonics::for_each_degree(kDegree, w, [&](int, const Lanes& y) {
    for (size_t m = 0; m < kOrders; ++m) result.push_back(static_cast<double>(static_cast<float>(y[m])));
  });
  return result;
}

// The textbook's formula.
double reference(int l, int m, double z, double phi) {
  double norm = (2 * l + 1) / (4 * std::numbers::pi) * (m > 0 ? 2 : 1);
  for (int k = l - m + 1; k <= l + m; ++k) norm /= k;
  return std::sqrt(norm) * std::assoc_legendre(static_cast<unsigned>(l), static_cast<unsigned>(m), z) *
         std::cos(m * phi);
}

TEST(SagittalHarmonics, AreTheTextbooks) {
  for (const double z : {-1.0, -0.9, -0.3, 0.0, 0.5, 0.98, 1.0})
    for (const double phi : {0.0, 0.4, 1.5, 2.9}) {
      const double sine = std::sqrt(1 - z * z);
      const std::vector<double> y = values(Vec3(Imath::V3d(sine * std::cos(phi), sine * std::sin(phi), z)));
      for (int l = 0; l <= kDegree; ++l)
        for (int m = 0; m < static_cast<int>(kOrders); ++m) {
          const double expected = m <= l ? reference(l, m, z, phi) : 0;
          EXPECT_NEAR(y[static_cast<size_t>(l) * kOrders + static_cast<size_t>(m)], expected,
                      3e-5 * (1 + std::abs(expected)))
              << l << " " << m << " at " << z << ", " << phi;
        }
    }
}

TEST(SagittalHarmonics, AreOrthonormal) {
  const GaussLegendre rule(40);
  constexpr int kAzimuths = 32;
  const size_t size = (kDegree + 1) * kOrders;
  std::vector<double> products(size * size);
  for (size_t k = 0; k < rule.size(); ++k)
    for (int a = 0; a < kAzimuths; ++a) {
      const double z = 2 * rule.node(k) - 1, phi = 2 * std::numbers::pi * (a + 0.5) / kAzimuths;
      const double sine = std::sqrt(1 - z * z);
      const std::vector<double> y = values(Vec3(Imath::V3d(sine * std::cos(phi), sine * std::sin(phi), z)));
      const double weight = rule.weight(k) * 2 * 2 * std::numbers::pi / kAzimuths;
      for (size_t i = 0; i < size; ++i)
        for (size_t j = 0; j < size; ++j) products[i * size + j] += weight * y[i] * y[j];
    }
  for (size_t i = 0; i < size; ++i)
    for (size_t j = 0; j < size; ++j)
      EXPECT_NEAR(products[i * size + j], i == j && i % kOrders <= i / kOrders ? 1 : 0, 2e-4) << i << " " << j;
}

TEST(SagittalView, HasTheAxisInItsPlane) {
  const Vec3 axis = normalize(Vec3(0.3f, -0.5f, 0.7f)), x(1.2f, 0.4f, -0.3f), w = normalize(Vec3(-0.2f, 0.9f, 0.1f));
  const SagittalView view(x, axis, w);
  EXPECT_NEAR(view.distance, length(x), 1e-6f);
  EXPECT_NEAR(view.cosine, dot(normalize(x), axis), 1e-6f);
  EXPECT_NEAR(view.direction.z, dot(normalize(x), w), 1e-6f);
  // The direction's part along the axis: the axis lies at -sine along x of the frame.
  EXPECT_NEAR(view.cosine * view.direction.z - safe_sqrt(1 - view.cosine * view.cosine) * view.direction.x,
              dot(w, axis), 1e-6f);
  EXPECT_NEAR(length(view.direction), 1, 1e-6f);
  EXPECT_EQ(SagittalView(axis * 2.0f, axis, w).direction.x, 0);
}

// Any number of directions, in groups or not, is the sum of each by itself.
TEST(SagittalHarmonics, OfManyDirectionsAddUp) {
  Rng rng(5);
  for (const int degree : {0, 3, kDegree})
    for (const size_t count : {1u, 4u, 6u, 11u}) {
      const size_t size = (static_cast<size_t>(degree) + 1) * kOrders;
      std::vector<Vec3> directions;
      std::vector<double> expected(size, 1);
      for (size_t i = 0; i < count; ++i) {
        const float u = rng.next_float();
        directions.push_back(square_to_sphere({u, rng.next_float()}));
        const std::vector<double> y = values(directions.back());
        for (size_t k = 0; k < size; ++k) expected[k] += y[k];
      }
      std::vector<float> sums(size, 1.0f);
      SagittalHarmonics::add_to(sums.data(), degree, directions);
      for (size_t k = 0; k < size; ++k) EXPECT_NEAR(static_cast<double>(sums[k]), expected[k], 1e-5) << k;
    }
}

}  // namespace
}  // namespace turbid
