#pragma once
#include "core/vector.h"

namespace turbid {

/// An orthonormal right-handed basis (s, t, n). "Local" vectors have their z axis along n.
struct Frame {
  Vec3 s{1, 0, 0}, t{0, 1, 0}, n{0, 0, 1};

  Frame() = default;
  Frame(const Vec3& s_axis, const Vec3& t_axis, const Vec3& normal) : s(s_axis), t(t_axis), n(normal) {}

  /// Any frame around the unit vector n, continuous but for n.z = 0 (Duff et al. 2017).
  explicit Frame(const Vec3& normal) : n(normal) {
    const float sign = std::copysign(1.0f, n.z);
    const float a = -1 / (sign + n.z);
    const float b = n.x * n.y * a;
    s = {1 + sign * sqr(n.x) * a, sign * b, -sign * n.x};
    t = {b, sign + sqr(n.y) * a, -n.y};
  }

  Vec3 to_local(const Vec3& v) const { return {dot(v, s), dot(v, t), dot(v, n)}; }
  Vec3 to_world(const Vec3& v) const { return s * v.x + t * v.y + n * v.z; }
};

/// The unit vector whose angle to the axis n of the frame has cosine mu and whose azimuth is phi (radians).
inline Vec3 direction_about(const Vec3& n, float mu, float phi) {
  const Frame frame(n);
  const float sin_theta = safe_sqrt(1 - mu * mu);
  return frame.s * (sin_theta * std::cos(phi)) + frame.t * (sin_theta * std::sin(phi)) + n * mu;
}

}  // namespace turbid
