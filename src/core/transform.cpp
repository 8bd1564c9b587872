#include "core/transform.h"

#include <stdexcept>

namespace turbid {
namespace {
Vec3 narrow(const Imath::V3d& v) { return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)}; }
Imath::V3d widen(const Vec3& v) { return Imath::V3d(v); }
}  // namespace

Transform::Transform(const double (&m)[4][4]) {
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) m_[column][row] = m[row][column];
  try {
    inverse_ = m_.inverse(true);
  } catch (const std::exception&) {
    throw std::invalid_argument("the transform is singular: it has no inverse");
  }
}

Transform Transform::translate(double x, double y, double z) {
  return Transform({{1, 0, 0, x}, {0, 1, 0, y}, {0, 0, 1, z}, {0, 0, 0, 1}});
}

Transform Transform::scale(double x, double y, double z) {
  return Transform({{x, 0, 0, 0}, {0, y, 0, 0}, {0, 0, z, 0}, {0, 0, 0, 1}});
}

Transform Transform::rotate(double x, double y, double z, double degrees) {
  const double norm = std::sqrt(x * x + y * y + z * z);
  if (!(norm > 0)) throw std::invalid_argument("a rotation needs an axis other than zero");
  x /= norm, y /= norm, z /= norm;
  const double angle = degrees * std::numbers::pi / 180, c = std::cos(angle), s = std::sin(angle), k = 1 - c;
  return Transform({{c + x * x * k, x * y * k - z * s, x * z * k + y * s, 0},
                    {y * x * k + z * s, c + y * y * k, y * z * k - x * s, 0},
                    {z * x * k - y * s, z * y * k + x * s, c + z * z * k, 0},
                    {0, 0, 0, 1}});
}

Transform Transform::look_at(const Imath::V3d& origin, const Imath::V3d& target, const Imath::V3d& up) {
  const Imath::V3d forward = (target - origin).normalized();
  if (!(forward.length() > 0.5)) throw std::invalid_argument("lookat: origin and target are the same point");
  const Imath::V3d left = up.cross(forward).normalized();
  if (!(left.length() > 0.5)) throw std::invalid_argument("lookat: up is zero or parallel to the viewing direction");
  const Imath::V3d top = forward.cross(left);
  return Transform({{left.x, top.x, forward.x, origin.x},
                    {left.y, top.y, forward.y, origin.y},
                    {left.z, top.z, forward.z, origin.z},
                    {0, 0, 0, 1}});
}

Transform Transform::operator*(const Transform& right) const {
  Transform result;
  result.m_ = right.m_ * m_;
  result.inverse_ = inverse_ * right.inverse_;
  return result;
}

Transform Transform::inverse() const {
  Transform result;
  result.m_ = inverse_;
  result.inverse_ = m_;
  return result;
}

Vec3 Transform::point(const Vec3& p) const { return narrow(widen(p) * m_); }

Vec3 Transform::vector(const Vec3& v) const {
  Imath::V3d result;
  m_.multDirMatrix(widen(v), result);
  return narrow(result);
}

Vec3 Transform::normal(const Vec3& n) const {
  Imath::V3d result;
  inverse_.transposed().multDirMatrix(widen(n), result);
  return narrow(result);
}

bool Transform::flips_handedness() const {
  const Imath::V3d x(m_[0][0], m_[0][1], m_[0][2]), y(m_[1][0], m_[1][1], m_[1][2]), z(m_[2][0], m_[2][1], m_[2][2]);
  return x.cross(y).dot(z) < 0;
}

double Transform::uniform_scale() const {
  const Imath::V3d x(m_[0][0], m_[0][1], m_[0][2]), y(m_[1][0], m_[1][1], m_[1][2]), z(m_[2][0], m_[2][1], m_[2][2]);
  const double s = x.length();
  const double tolerance = 1e-5 * s;  // rounding of decimal matrices in scene files
  const bool equal = std::abs(y.length() - s) < tolerance && std::abs(z.length() - s) < tolerance;
  const bool orthogonal =
      std::abs(x.dot(y)) < tolerance * s && std::abs(y.dot(z)) < tolerance * s && std::abs(z.dot(x)) < tolerance * s;
  return equal && orthogonal ? s : 0;
}

}  // namespace turbid
