#include "sensor/clip_range.h"

#include <stdexcept>

namespace turbid {

void check(const ClipRange& clip) {
  if (!(clip.near_clip >= 0)) throw std::invalid_argument("near_clip must not be negative");
  if (!(clip.far_clip > clip.near_clip)) throw std::invalid_argument("far_clip must be greater than near_clip");
}

}  // namespace turbid
