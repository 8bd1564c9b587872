#include <algorithm>
#include <cmath>

#include "geometry/generated.h"
#include "geometry/row_mesh.h"

namespace turbid {
namespace {
/// Unit normal to the right of the step from a to b; zero for no step.
Vec2 right_normal(const Vec2& a, const Vec2& b) {
  const Vec2 step = b - a;
  const float norm = std::sqrt(step.x * step.x + step.y * step.y);
  return norm > 0 ? Vec2(step.y, -step.x) * (1 / norm) : Vec2(0.0f);
}

/// A profile point with the normal of the surface there, both (radius, height).
struct ProfilePoint {
  Vec2 p, n;
};

/// Turns a profile around the y axis.
MeshData revolve(std::string name, std::span<const ProfilePoint> profile, int segments) {
  const auto columns = static_cast<uint32_t>(segments) + 1;
  float length = 0;
  for (size_t k = 1; k < profile.size(); ++k) length += (profile[k].p - profile[k - 1].p).length();
  RowMesh mesh(std::move(name));
  float travelled = 0;
  for (size_t k = 0; k < profile.size(); ++k) {
    const auto& [p, n] = profile[k];
    if (k > 0) travelled += (p - profile[k - 1].p).length();
    const uint32_t row = mesh.size();
    for (uint32_t j = 0; j < columns; ++j) {
      // The last column repeats the first to the bit, so that the surface closes.
      const double phi = 2 * std::numbers::pi * (j % static_cast<uint32_t>(segments)) / segments;
      const auto c = static_cast<float>(std::cos(phi)), s = static_cast<float>(std::sin(phi));
      mesh.add({p.x * c, p.y, p.x * s}, {n.x * c, n.y, n.x * s},
               {static_cast<float>(j) / static_cast<float>(segments), travelled / length});
    }
    if (k > 0 && p != profile[k - 1].p) mesh.join(row - columns, row, columns);
  }
  return mesh.take();
}

void require_segments(int segments) {
  require(segments >= 3 && segments <= 65536, "the number of segments must be between 3 and 65536");
}
}  // namespace

MeshData make_uv_sphere(float radius, int segments, int rings) {
  require(radius > 0, "uv_sphere: the radius must be positive");
  require(rings >= 2 && rings <= 65536, "uv_sphere: the number of rings must be between 2 and 65536");
  require_segments(segments);
  std::vector<ProfilePoint> profile;
  for (int k = 0; k <= rings; ++k) {
    const bool pole = k == 0 || k == rings;
    const float theta = kPi * static_cast<float>(k) / static_cast<float>(rings);
    const Vec2 n(pole ? 0 : std::sin(theta), k == rings ? 1 : -std::cos(theta));
    profile.push_back({n * radius, n});
  }
  return revolve("uv sphere", profile, segments);
}

MeshData make_torus(float major_radius, float minor_radius, int major_segments, int minor_segments) {
  require(minor_radius > 0 && major_radius > minor_radius,
          "torus: the radii must satisfy 0 < minor_radius < major_radius");
  require_segments(major_segments);
  require_segments(minor_segments);
  std::vector<ProfilePoint> profile;
  for (int k = 0; k <= minor_segments; ++k) {
    const float phi = 2 * kPi * static_cast<float>(k % minor_segments) / static_cast<float>(minor_segments);
    const Vec2 n(std::cos(phi), std::sin(phi));
    profile.push_back({Vec2(major_radius, 0) + n * minor_radius, n});
  }
  return revolve("torus", profile, major_segments);
}

MeshData make_lathe(std::span<const Vec2> profile, int segments) {
  require_segments(segments);
  require(profile.size() >= 3, "lathe: the profile needs at least 3 points");
  for (const Vec2& p : profile)
    require(std::isfinite(p.x) && std::isfinite(p.y) && p.x >= 0,
            "lathe: profile points must be finite, with radius >= 0");
  const size_t last = profile.size() - 1;
  const bool ring = profile[0] == profile[last];
  require(ring || (profile[0].x == 0 && profile[last].x == 0),
          "lathe: the profile must begin and end on the axis, or be a ring");

  std::vector<ProfilePoint> points;
  for (size_t k = 0; k <= last; ++k) {
    const Vec2 p = profile[k];
    Vec2 before(0.0f), after(0.0f);
    if (k > 0) before = right_normal(profile[k - 1], p);
    if (k < last) after = right_normal(p, profile[k + 1]);
    if (ring && k == 0) before = right_normal(profile[last - 1], p);
    if (ring && k == last) after = right_normal(p, profile[1]);
    Vec2 n = before + after;
    if (p.x == 0) n.x = 0;  // by symmetry about the axis
    if (!(n.length() > 0)) n = {p.x == 0 ? 0.0f : 1.0f, p.x == 0 ? 1.0f : 0.0f};
    points.push_back({p, n.normalized()});
  }
  return revolve("lathe", points, segments);
}

std::vector<Vec2> smooth_profile(std::span<const Vec2> points, int steps) {
  require(steps >= 1 && steps <= 4096, "the number of steps must be between 1 and 4096");
  std::vector<Vec2> curve;
  float widest = 0;
  for (const Vec2& p : points) widest = std::max(widest, p.x);
  const float least_radius = 1e-4f * widest;  // between its ends the curve must stay off the axis
  for (size_t begin = 0; begin < points.size();) {
    size_t end = begin + 1;
    while (end < points.size() && points[end] != points[end - 1]) ++end;
    const std::span<const Vec2> run = points.subspan(begin, end - begin);
    const size_t last = run.size() - 1;
    // Past an end the curve goes on straight, or mirrored where it meets the axis, which makes it meet it squarely.
    const auto beyond = [](const Vec2& at, const Vec2& next) {
      return at.x == 0 ? Vec2(-next.x, next.y) : at * 2.0f - next;
    };
    for (size_t k = 0; k < last; ++k) {
      const Vec2 p1 = run[k], p2 = run[k + 1];
      const Vec2 p0 = k > 0 ? run[k - 1] : beyond(p1, p2), p3 = k + 2 <= last ? run[k + 2] : beyond(p2, p1);
      curve.push_back(p1);
      for (int i = 1; i <= steps; ++i) {
        const float t = static_cast<float>(i) / static_cast<float>(steps + 1), t2 = t * t, t3 = t2 * t;
        // Catmull & Rom 1974, uniform.
        Vec2 p = (p1 * 2.0f + (p2 - p0) * t + (p0 * 2.0f - p1 * 5.0f + p2 * 4.0f - p3) * t2 +
                  (p1 * 3.0f - p0 - p2 * 3.0f + p3) * t3) *
                 0.5f;
        p.x = std::max(p.x, least_radius);
        curve.push_back(p);
      }
    }
    curve.push_back(run[last]);
    begin = end;
  }
  return curve;
}

}  // namespace turbid
