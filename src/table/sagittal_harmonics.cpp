#include "table/sagittal_harmonics.h"

#include <cmath>
#include <numbers>

namespace turbid {

const SagittalHarmonics::Recurrence SagittalHarmonics::kRecurrence;

// P_lm = a (cos theta P_{l-1,m} - c P_{l-2,m}), a^2 = (4 l^2 - 1) / (l^2 - m^2), c^2 = ((l-1)^2 - m^2) / (4 (l-1)^2 -
// 1), from P_mm / sin^m = sqrt((2m+1)!! / (2m)!! / (4 pi)).
SagittalHarmonics::Recurrence::Recurrence() {
  double squared = 1 / (4 * std::numbers::pi);
  for (int m = 0; m < kOrders; ++m) {
    const auto lane = static_cast<size_t>(m);
    if (m > 0) squared *= (2.0 * m + 1) / (2.0 * m);
    seed[lane][lane] = static_cast<float>(std::sqrt(m > 0 ? 2 * squared : squared));
    alternating[lane] = m % 2 == 0 ? 1.0f : -1.0f;
    for (int l = m + 1; l <= kMaxDegree; ++l) {
      const double a_l = std::sqrt((4.0 * l * l - 1) / (1.0 * l * l - m * m));
      const double below = l - 1.0;
      a[static_cast<size_t>(l)][lane] = static_cast<float>(a_l);
      b[static_cast<size_t>(l)][lane] =
          l == m + 1 ? 0 : static_cast<float>(a_l * std::sqrt((below * below - m * m) / (4 * below * below - 1)));
    }
  }
}

void SagittalHarmonics::add_to(float* sums, int degree, std::span<const Vec3> directions) {
  constexpr size_t kTogether = 4;
  for (size_t first = 0; first < directions.size(); first += kTogether) {
    std::array<Direction, kTogether> w;
    for (size_t k = 0; k < std::min(kTogether, directions.size() - first); ++k) w[k] = Direction(directions[first + k]);
    for_each_degree(degree, w, [&](int l, const std::array<Lanes, kTogether>& y) {
      float* const row = sums + l * kOrders;
      (load_lanes(row) + ((y[0] + y[1]) + (y[2] + y[3]))).copy_to(row, std::experimental::element_aligned);
    });
  }
}

}  // namespace turbid
