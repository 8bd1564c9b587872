#pragma once
#include <algorithm>
#include <cmath>

namespace turbid {

/// Up to this linear value the PNG shows radiance as it is; above, highlights roll off.
inline constexpr float kToneKnee = 0.7f;

/// The tone curve of the PNG beside a render, per channel of linear radiance: the identity up to kToneKnee, then
/// k + (1 - k) (1 - e^(-(v - k)/(1 - k))), which goes on with the same slope and approaches 1. Radiance 1 becomes 0.89;
/// a bright colour fades to white as it approaches the limit. Negative values and NaN give 0.
inline float tone_curve(float v) {
  if (!(v > 0)) return 0;
  if (v <= kToneKnee) return v;
  return 1 - (1 - kToneKnee) * std::exp(-(v - kToneKnee) / (1 - kToneKnee));
}

}  // namespace turbid
