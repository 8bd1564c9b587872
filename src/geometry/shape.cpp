#include "geometry/shape.h"

namespace turbid {
namespace {
/// 1/sr at `from` of a density over the area at p, whose normal is ng; 0 where the surface is seen edge-on.
float area_to_solid_angle(float pdf_a, const Vec3& from, const Vec3& p, const Vec3& ng) {
  const Vec3 to = p - from;
  const float distance_squared = length_squared(to);
  const float cosine_times_distance = std::abs(dot(to, ng));
  return cosine_times_distance > 0 ? pdf_a * distance_squared * std::sqrt(distance_squared) / cosine_times_distance : 0;
}
}  // namespace

std::optional<Shape::DirectSample> Shape::sample_direct(const Vec3& from, const Vec2& u) const {
  const AreaSample sample = sample_area(u);
  const float pdf_w = area_to_solid_angle(sample.pdf_a, from, sample.point.p, sample.point.ng);
  if (!(pdf_w > 0) || !std::isfinite(pdf_w)) return std::nullopt;
  return DirectSample{sample.point, pdf_w};
}

float Shape::pdf_direct_w(const Vec3& from, const Vec3& p, const Vec3& ng) const {
  const float pdf_w = area_to_solid_angle(pdf_a(), from, p, ng);
  return std::isfinite(pdf_w) ? pdf_w : 0;
}

}  // namespace turbid
