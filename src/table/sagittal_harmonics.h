#pragma once
#include <span>

#include "table/lanes.h"

namespace turbid {

/// Real spherical harmonics Y_lm(w) that are even about a plane: those with cos(m phi). Orthonormal over the sphere, no
/// Condon-Shortley sign: Y_lm = N_lm P_l^m(cos theta) cos(m phi), N_lm^2 = (2 - [m = 0]) (2l+1)/(4 pi) (l-m)!/(l+m)!.
///
/// Light of an axially symmetric source is even about the plane through its axis and the point where it is looked at,
/// the sagittal plane, so these are all that it has. The orders m of one degree l lie in the lanes of one vector.
class SagittalHarmonics {
 public:
  static constexpr int kMaxDegree = 32;
  static constexpr int kOrders = kLanes;  ///< m = 0 ... 7; what lies above m = l is 0

  /// Where the recurrence over degrees begins: sin^m theta cos(m phi) = Re (x + i y)^m of a unit vector with polar axis
  /// z and the sagittal plane y = 0. Left out: all harmonics are 0.
  struct Direction {
    Lanes z{0.0f}, power{0.0f};

    Direction() = default;
    explicit Direction(const Vec3& w) : z(w.z) {
      const float x2 = w.x * w.x - w.y * w.y, y2 = 2 * w.x * w.y;
      const float x3 = x2 * w.x - y2 * w.y, y3 = x2 * w.y + y2 * w.x;
      const float x4 = x2 * x2 - y2 * y2, y4 = 2 * x2 * y2;
      power = load_lanes({1, w.x, x2, x3, x4, x4 * w.x - y4 * w.y, x3 * x3 - y3 * y3, x4 * x3 - y4 * y3});
    }
  };

  /// Calls visit(l, Y) for l = 0 ... degree with lanes Y[k][m] = Y_lm of the k-th of N directions. The recurrence is a
  /// chain in which each step waits for the one before: several directions at once fill the gaps.
  template <size_t N, class Visit>
  static void for_each_degree(int degree, const std::array<Direction, N>& w, const Visit& visit) {
    // Normalised Legendre recurrence over l, for all m at once; lane m begins at l = m.
    std::array<Lanes, N> now, before;  // `before` is weighed by b already, ahead of time
    for (size_t k = 0; k < N; ++k) {
      now[k] = load_lanes(kRecurrence.seed[0]) * w[k].power;
      before[k] = Lanes(0.0f);
    }
    visit(0, now);
    for (int l = 1; l <= degree; ++l) {
      const auto i = static_cast<size_t>(l);
      const Lanes a = load_lanes(kRecurrence.a[i]), next_b = load_lanes(kRecurrence.b[i + 1]);
      for (size_t k = 0; k < N; ++k) {
        Lanes next = a * w[k].z * now[k] - before[k];
        if (l < kOrders) next += load_lanes(kRecurrence.seed[i]) * w[k].power;
        before[k] = next_b * now[k];
        now[k] = next;
      }
      visit(l, now);
    }
  }
  /// The same of one direction, visit(l, Y[m]).
  template <class Visit>
  static void for_each_degree(int degree, const Vec3& w, const Visit& visit) {
    for_each_degree<1>(degree, std::array{Direction(w)}, [&](int l, const auto& y) { visit(l, y[0]); });
  }

  /// Adds the harmonics of all these directions to sums[l][m], degree + 1 rows of kOrders.
  static void add_to(float* sums, int degree, std::span<const Vec3> directions);

  /// 1, -1, 1, ...: what mirroring the polar axis' azimuth by pi does to each order.
  static Lanes alternating() { return load_lanes(kRecurrence.alternating); }

 private:
  struct Recurrence {
    Recurrence();
    std::array<LaneRow, kMaxDegree + 2> a{}, b{};
    std::array<LaneRow, kOrders> seed{};
    LaneRow alternating{};
  };
  static const Recurrence kRecurrence;
};

}  // namespace turbid
