#pragma once
#include <embree3/rtcore.h>

#include <optional>

#include "core/ray.h"
#include "geometry/surface_point.h"

namespace turbid {

/// What a ray cast found: where, and which primitive of which shape. `Shape::surface_point` makes the rest of it.
struct Hit {
  float t = kInfinity;
  uint32_t shape = RTC_INVALID_GEOMETRY_ID;  ///< index in the RayCaster's list of shapes
  uint32_t primitive = 0;
  Vec2 barycentric{0, 0};
  Vec3 ng{0, 0, 0};  ///< not normalised, on the outside of the shape

  explicit operator bool() const { return shape != RTC_INVALID_GEOMETRY_ID; }
};

/// A point drawn from the area of a shape.
struct AreaSample {
  SurfacePoint point;
  float pdf_a;  ///< per unit area
};

/// Geometry alone: a set of surfaces in world space that can be hit, sampled and measured. What it is made of is not
/// its business (see scene/). Immutable, shared between threads.
class Shape {
 public:
  virtual ~Shape() = default;

  virtual Bounds3 bounds() const = 0;
  virtual float area() const = 0;
  virtual size_t primitive_count() const { return 1; }
  /// True when the surface encloses a volume without holes, so that it can bound a medium.
  virtual bool is_closed() const = 0;

  /// The point that a ray hit.
  virtual SurfacePoint surface_point(const Ray& ray, const Hit& hit) const = 0;

  /// A point uniform in area; takes two numbers.
  virtual AreaSample sample_area(const Vec2& u) const = 0;
  /// Density of sample_area, per unit area: 1 / area().
  float pdf_a() const { return 1 / area(); }

  /// A point for light transport towards `from`, in solid angle at `from` where the shape knows how (a sphere samples
  /// the cone it fills); `pdf_w` is 1/sr as seen from `from`. Takes two numbers. May be empty (nothing faces `from`).
  struct DirectSample {
    SurfacePoint point;
    float pdf_w;
  };
  virtual std::optional<DirectSample> sample_direct(const Vec3& from, const Vec2& u) const;
  /// Density of sample_direct at the point p of this shape with geometric normal ng, 1/sr at `from`.
  virtual float pdf_direct_w(const Vec3& from, const Vec3& p, const Vec3& ng) const;

  /// A committed Embree geometry of this shape, owned by the caller (rtcReleaseGeometry). Rays keep Hit::t, primitive,
  /// barycentric and ng right.
  virtual RTCGeometry make_embree_geometry(RTCDevice device) const = 0;

  /// A lower bound on the distance from p to the surface, cheap and exact where possible; never above the true one.
  virtual float distance_bound(const Vec3& p, uint32_t primitive) const = 0;
};

}  // namespace turbid
