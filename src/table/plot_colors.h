#pragma once
#include <algorithm>

#include "core/vector.h"

namespace turbid {

/// What plots of tables are drawn in.
inline const Vec3 kPlotBlue(0.1f, 0.4f, 1), kPlotGreen(0.2f, 0.9f, 0.3f), kPlotGrey(0.45f);

/// Black at 0, over red and yellow to white at 1.
inline Vec3 heat(float x) {
  return {std::clamp(3 * x, 0.0f, 1.0f), std::clamp(3 * x - 1, 0.0f, 1.0f), std::clamp(3 * x - 2, 0.0f, 1.0f)};
}

}  // namespace turbid
