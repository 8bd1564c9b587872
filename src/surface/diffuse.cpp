#include "surface/diffuse.h"

#include "core/warp.h"

namespace turbid {

Bsdf::Eval Diffuse::eval(const SurfacePoint& point, const Vec3& given, const Vec3& chosen, TransportMode) const {
  if (given.z <= 0 || chosen.z <= 0) return {};
  const float pdf_w = cosine_hemisphere_pdf_w(chosen);
  return {reflectance_.eval(point) * pdf_w, pdf_w};
}

std::optional<BsdfSample> Diffuse::sample(const SurfacePoint& point, const Vec3& given, float, const Vec2& u,
                                          TransportMode) const {
  if (given.z <= 0) return std::nullopt;
  const Vec3 chosen = square_to_cosine_hemisphere(u);
  if (chosen.z <= 0) return std::nullopt;
  return BsdfSample{chosen, reflectance_.eval(point), cosine_hemisphere_pdf_w(chosen), flags(), 1};
}

}  // namespace turbid
