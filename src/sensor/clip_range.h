#pragma once

namespace turbid {

/// The planes across the sensor's axis between which things are seen, as distances along the axis, scene units (for an
/// orthographic sensor: units of its own space). 0 <= near < far.
struct ClipRange {
  float near_clip = 1e-2f, far_clip = 1e4f;
};

/// Throws std::invalid_argument unless 0 <= near < far.
void check(const ClipRange& clip);

}  // namespace turbid
