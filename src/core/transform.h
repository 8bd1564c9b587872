#pragma once
#include <Imath/ImathMatrix.h>

#include "core/ray.h"

namespace turbid {

/// An affine (or, for projections, projective) map with its inverse. Matrices are double inside, so that a chain of
/// scene-file transforms loses nothing; points and vectors are float. Column-vector convention: A * B applies B first.
class Transform {
 public:
  Transform() = default;
  /// Row-major 4x4 entries m[row][column], column-vector convention. Throws std::invalid_argument when singular.
  explicit Transform(const double (&m)[4][4]);

  static Transform translate(double x, double y, double z);
  static Transform scale(double x, double y, double z);
  /// Counter-clockwise about the axis (x, y, z) by `degrees`.
  static Transform rotate(double x, double y, double z, double degrees);
  /// Camera-to-world: looks from `origin` along +z to `target`, with +y near `up`; +x points to the left of the image.
  /// Throws std::invalid_argument when target = origin or up is parallel to the view.
  static Transform look_at(const Imath::V3d& origin, const Imath::V3d& target, const Imath::V3d& up);

  Transform operator*(const Transform& right) const;
  bool operator==(const Transform& other) const { return m_ == other.m_; }
  Transform inverse() const;
  double at(int row, int column) const { return m_[column][row]; }

  Vec3 point(const Vec3& p) const;
  Vec3 vector(const Vec3& v) const;
  /// Normals transform by the inverse transpose; the result is not normalised.
  Vec3 normal(const Vec3& n) const;
  /// True when the handedness changes (determinant of the linear part negative).
  bool flips_handedness() const;
  /// The factor of a similarity (rotation, uniform scale, translation); 0 when the map is not one.
  double uniform_scale() const;

 private:
  Imath::M44d m_, inverse_;  // Imath's row-vector convention: stored transposed
};

}  // namespace turbid
