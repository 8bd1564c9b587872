#include "manylight/volume_points.h"

namespace turbid {

MadeDistance collide_before(const HomogeneousMedium& medium, float length, const Spectrum& mix, float u) {
  const Spectrum sigma_t = medium.sigma_t();
  const MadeDistance even{length * u, 1 / length};
  if (!(sigma_t.max() > 0)) return even;
  // 1 - T(length) by expm1: thin media keep their digits.
  const auto share_colliding = [&](int c) { return -std::expm1(-sigma_t[c] * length); };
  int picked = 0;
  while (picked + 1 < kChannels && u >= mix[picked]) u -= mix[picked++];
  while (mix[picked] <= 0 && picked > 0) u = kOneMinusEpsilon * mix[--picked];
  const float within = std::min(u / mix[picked], kOneMinusEpsilon);
  const float t = sigma_t[picked] > 0
                      ? std::min(-std::log1p(-within * share_colliding(picked)) / sigma_t[picked], length)
                      : within * length;
  float pdf_t = 0;
  for (int c = 0; c < kChannels; ++c)
    pdf_t += mix[c] * (sigma_t[c] > 0 ? sigma_t[c] * std::exp(-sigma_t[c] * t) / share_colliding(c) : 1 / length);
  return {t, pdf_t};
}

}  // namespace turbid
