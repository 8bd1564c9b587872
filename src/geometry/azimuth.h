#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>

namespace turbid {

/// Angle of (x, y) from the x axis as a fraction of the circle, in [0, 1]; 0 for (0, 0). Within 2e-8 of
/// atan2(y, x) / (2 pi), at a fraction of its cost: surface points need it for each hit on a curved shape.
inline float turn_of(float x, float y) {
  const float ax = std::abs(x), ay = std::abs(y);
  const float larger = std::max(ax, ay), smaller = std::min(ax, ay);
  const float r = larger > 0 ? smaller / larger : 0, r2 = r * r;
  // atan(r) / r on [0, 1], interpolated in r^2 at Chebyshev points: 6.4e-8 rad at most.
  float p = -0.00455979199f;
  for (const float c :
       {0.0237805186f, -0.0588297531f, 0.0986886546f, -0.140032902f, 0.199669618f, -0.333318127f, 0.999999882f})
    p = p * r2 + c;
  constexpr float kTurnPerRadian = 0.5f * std::numbers::inv_pi_v<float>;
  float turn = p * r * kTurnPerRadian;
  if (ay > ax) turn = 0.25f - turn;
  if (x < 0) turn = 0.5f - turn;
  return y < 0 ? 1 - turn : turn;
}

}  // namespace turbid
