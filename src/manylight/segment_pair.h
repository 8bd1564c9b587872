#pragma once
#include "core/ray.h"
#include "core/vector.h"

namespace turbid {

/// Light that collides on one straight segment and then on another (virtual ray lights, Novak et al. 2012): one place
/// on each, drawn in proportion to phase functions over squared distance as nearly as closed forms and small tables
/// know. Both segments are rays of finite length; directions unit, the way that each walk goes.

/// A place on a segment and its density, 1/length.
struct PlaceOnSegment {
  float t = 0;
  double pdf_t = 0;
};

/// How the two ends deflect, about: mean cosines of the phase functions. They shape densities alone.
struct SegmentLobes {
  float g_light = 0;   ///< on the segment of the light
  float g_sensor = 0;  ///< on that of the sensor, or at the point
};

/// A place on `segment` for a point p: density 1/d^2 (equiangular, Kulla & Fajardo 2012) times, in kStrata steps of the
/// angle, the lobe of a collision there with mean cosine g. `from_light`: light goes along the segment and then to p;
/// else it goes from p to the segment, which the sensor's walk follows. Takes one number. Not where p lies on the
/// segment: its density is then that of a place nearby, which is right as well.
PlaceOnSegment place_towards(const Ray& segment, const Vec3& p, float g, float u);
double pdf_towards(const Ray& segment, const Vec3& p, float g, float t);

/// Places on the segments of a light and of the sensor.
struct SegmentPair {
  float on_light = 0, on_sensor = 0;
  double pdf = 0;  ///< 1/length^2
};
/// First the place on the light's segment: density 1/D, D its distance from the line of the other (which is what is
/// left of 1/d^2 when the other is integrated over), in kStrata steps weighted by the angle that the other segment
/// subtends and by both lobes; then that on the other by place_towards with both lobes. Takes two numbers.
SegmentPair sample_pair(const Ray& light, const Ray& sensor, const SegmentLobes& lobes, const Vec2& u);
double pdf_pair(const Ray& light, const Ray& sensor, const SegmentLobes& lobes, float on_light, float on_sensor);

}  // namespace turbid
