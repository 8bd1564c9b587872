#include "sensor/field_of_view.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace turbid {
namespace {
constexpr double kDegree = std::numbers::pi / 180;
}

double horizontal_fov(double degrees, FovAxis axis, double aspect) {
  if (!(degrees > 0 && degrees < 180))
    throw std::invalid_argument("a field of view must lie between 0 and 180 degrees, both excluded");
  if (!(aspect > 0)) throw std::invalid_argument("the aspect of a film must be positive");
  if (axis == FovAxis::kSmaller) axis = aspect > 1 ? FovAxis::kY : FovAxis::kX;
  if (axis == FovAxis::kLarger) axis = aspect > 1 ? FovAxis::kX : FovAxis::kY;
  if (axis == FovAxis::kX) return degrees;
  const double along = std::tan(degrees * kDegree / 2);
  const double across = axis == FovAxis::kY ? along * aspect : along / std::sqrt(1 + 1 / (aspect * aspect));
  return 2 * std::atan(across) / kDegree;
}

double diagonal_fov_of_focal_length(double millimetres) {
  if (!(millimetres > 0)) throw std::invalid_argument("a focal length must be positive");
  return 2 * std::atan(std::hypot(36.0, 24.0) / (2 * millimetres)) / kDegree;
}

}  // namespace turbid
