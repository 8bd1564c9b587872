#pragma once
#include <array>
#include <experimental/simd>

#include "core/vector.h"

namespace turbid {

/// Real spherical harmonics Y_lm(w) that are even about a plane: those with cos(m phi). Orthonormal over the sphere, no
/// Condon-Shortley sign: Y_lm = N_lm P_l^m(cos theta) cos(m phi), N_lm^2 = (2 - [m = 0]) (2l+1)/(4 pi) (l-m)!/(l+m)!.
///
/// Light of an axially symmetric source is even about the plane through its axis and the point where it is looked at,
/// the sagittal plane, so these are all that it has. The orders m of one degree l lie in the lanes of one vector.
class SagittalHarmonics {
 public:
  static constexpr int kMaxDegree = 32;
  static constexpr int kOrders = 8;  ///< m = 0 ... 7; what lies above m = l is 0
  using Lanes = std::experimental::simd<float, std::experimental::simd_abi::deduce_t<float, kOrders>>;
  using Row = std::array<float, kOrders>;

  /// Calls visit(l, Y) for l = 0 ... degree with the lanes Y[m] = Y_lm(w); w is a unit vector with polar axis z and the
  /// sagittal plane y = 0.
  template <class Visit>
  static void for_each_degree(int degree, const Vec3& w, const Visit& visit) {
    // sin^m theta cos(m phi) = Re (x + i y)^m
    const float x2 = w.x * w.x - w.y * w.y, y2 = 2 * w.x * w.y;
    const float x3 = x2 * w.x - y2 * w.y, y3 = x2 * w.y + y2 * w.x;
    const float x4 = x2 * x2 - y2 * y2, y4 = 2 * x2 * y2;
    alignas(64) const Row powers{1, w.x, x2, x3, x4, x4 * w.x - y4 * w.y, x3 * x3 - y3 * y3, x4 * x3 - y4 * y3};
    const Lanes power = load(powers), z(w.z);
    // Normalised Legendre recurrence over l, for all m at once; lane m begins at l = m.
    Lanes before(0.0f), now = load(kRecurrence.seed[0]) * power;
    visit(0, now);
    for (int l = 1; l <= degree; ++l) {
      const auto i = static_cast<size_t>(l);
      Lanes next = load(kRecurrence.a[i]) * z * now - load(kRecurrence.b[i]) * before;
      if (l < kOrders) next += load(kRecurrence.seed[i]) * power;
      before = now;
      now = next;
      visit(l, now);
    }
  }

  static Lanes load(const Row& row) { return Lanes(row.data(), std::experimental::element_aligned); }
  static Lanes load(const float* row) { return Lanes(row, std::experimental::element_aligned); }
  /// 1, -1, 1, ...: what mirroring the polar axis' azimuth by pi does to each order.
  static Lanes alternating() { return load(kRecurrence.alternating); }

 private:
  struct Recurrence {
    Recurrence();
    std::array<Row, kMaxDegree + 1> a{}, b{};
    std::array<Row, kOrders> seed{};
    Row alternating{};
  };
  static const Recurrence kRecurrence;
};

}  // namespace turbid
