#include "geometry/sdf_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "geometry/affine.h"
#include "geometry/shading_frame.h"
#include "geometry/user_geometry.h"

namespace turbid {
using Imath::V3d;
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

/// Exact at 0 and 1, so that cells agree where they meet.
double lerp(double a, double b, double t) { return (1 - t) * a + t * b; }

/// x + 2 y + 4 z; x first, then y, then z.
double trilerp(const std::array<double, 8>& c, const V3d& p) {
  return lerp(lerp(lerp(c[0], c[1], p.x), lerp(c[2], c[3], p.x), p.y),
              lerp(lerp(c[4], c[5], p.x), lerp(c[6], c[7], p.x), p.y), p.z);
}

V3d trilerp_gradient(const std::array<double, 8>& c, const V3d& p) {
  const auto across = [&](int a, int b, int step, double s, double t) {
    const auto at = [&](int i) { return c[static_cast<size_t>(i + step)] - c[static_cast<size_t>(i)]; };
    return lerp(lerp(at(0), at(a), s), lerp(at(b), at(a + b), s), t);
  };
  return {across(2, 4, 1, p.y, p.z), across(1, 4, 2, p.x, p.z), across(1, 2, 4, p.x, p.y)};
}

/// Coefficients of a cubic, from its values at 0, 1/3, 2/3 and 1.
struct Cubic {
  double c0, c1, c2, c3;

  Cubic(double f0, double f1, double f2, double f3)
      : c0(f0),
        c1((-11 * f0 + 18 * f1 - 9 * f2 + 2 * f3) / 2),
        c2((18 * f0 - 45 * f1 + 36 * f2 - 9 * f3) / 2),
        c3((-9 * f0 + 27 * f1 - 27 * f2 + 9 * f3) / 2) {}

  double operator()(double s) const { return ((c3 * s + c2) * s + c1) * s + c0; }

  /// Where the derivative vanishes inside (0, 1), in order; missing ones are 1.
  std::array<double, 2> extrema() const {
    const double a = 3 * c3, half_b = c2, discriminant = half_b * half_b - a * c1;
    if (!(discriminant > 0)) return {1, 1};
    const double q = -(half_b + std::copysign(std::sqrt(discriminant), half_b));
    std::array<double, 2> roots{q / a, c1 / q};
    for (double& root : roots)
      if (!(root > 0 && root < 1)) root = 1;
    if (roots[0] > roots[1]) std::swap(roots[0], roots[1]);
    return roots;
  }
};

/// The change of sign of a function that is monotonic on [near, far]; `near_inside`: it is negative at near.
template <class Function>
double find_crossing(const Function& f, double near, double far, bool near_inside) {
  constexpr int kSteps = 60;
  double f_near = f(near), f_far = f(far);
  for (int i = 0; i < kSteps && far - near > 1e-15 * far; ++i) {
    // Regula falsi and bisection in turn: the one is fast, the other one never slow.
    const double middle = near + (far - near) / 2, secant = near - f_near * (far - near) / (f_far - f_near);
    const double s = i % 2 == 0 && secant > near && secant < far ? secant : middle;
    if (!(s > near && s < far)) break;
    const double f_s = f(s);
    if ((f_s < 0) == near_inside)
      near = s, f_near = f_s;
    else
      far = s, f_far = f_s;
  }
  return far;
}

}  // namespace

SdfGrid::SdfGrid(SdfSamples samples, Normals normals, const Transform& to_world, bool flip_normals)
    : samples_(std::move(samples)), normals_(normals), flip_normals_(flip_normals) {
  const auto [nx, ny, nz] = samples_.size;
  if (std::min({nx, ny, nz}) < 2)
    throw std::invalid_argument(fmt::format("sdfgrid: {} x {} x {} samples span no cell", nx, ny, nz));
  const auto count = static_cast<size_t>(nx) * static_cast<size_t>(ny) * static_cast<size_t>(nz);
  if (samples_.values.size() != count || count >= (size_t{1} << 32))
    throw std::invalid_argument("sdfgrid: the number of samples does not fit the grid");
  for (const float v : samples_.values)
    if (!std::isfinite(v)) throw std::invalid_argument("sdfgrid: a sample is not finite");
  const auto step = [](int n) { return 1.0 / (n - 1); };
  grid_to_world_ = to_world * Transform::scale(step(nx), step(ny), step(nz));
  world_to_grid_ = grid_to_world_.inverse();
  least_stretch_ = turbid::least_stretch(grid_to_world_);
  if (!(least_stretch_ > 0)) throw std::invalid_argument("sdfgrid: to_world must be affine and not flat");

  for (int z = 0; z < nz; ++z)
    for (int y = 0; y < ny; ++y)
      for (int x = 0; x < nx; ++x) {
        const bool border = x == 0 || y == 0 || z == 0 || x == nx - 1 || y == ny - 1 || z == nz - 1;
        if (border && sample(x, y, z) < 0) closed_ = false;
        if (x == nx - 1 || y == ny - 1 || z == nz - 1) continue;
        const Corners c = corners({x, y, z});
        const auto inside = std::count_if(c.begin(), c.end(), [](double v) { return v < 0; });
        if (inside == 0 || inside == 8) continue;
        cells_.push_back(static_cast<uint32_t>((z * ny + y) * nx + x));
        bounds_.extendBy(cell_bounds(static_cast<uint32_t>(cells_.size() - 1)));
      }
  if (cells_.empty())
    throw std::invalid_argument("sdfgrid: the samples change their sign nowhere: there is no surface");
}

double SdfGrid::sample(int x, int y, int z) const {
  const auto index = (static_cast<size_t>(z) * static_cast<size_t>(samples_.size[1]) + static_cast<size_t>(y)) *
                         static_cast<size_t>(samples_.size[0]) +
                     static_cast<size_t>(x);
  return static_cast<double>(samples_.values[index]);
}

std::array<int, 3> SdfGrid::cell_place(uint32_t primitive) const {
  const uint32_t index = cells_[primitive], nx = static_cast<uint32_t>(samples_.size[0]),
                 ny = static_cast<uint32_t>(samples_.size[1]);
  return {static_cast<int>(index % nx), static_cast<int>(index / nx % ny), static_cast<int>(index / nx / ny)};
}

SdfGrid::Corners SdfGrid::corners(const std::array<int, 3>& cell) const {
  Corners c;
  for (int i = 0; i < 8; ++i)
    c[static_cast<size_t>(i)] = sample(cell[0] + (i & 1), cell[1] + (i >> 1 & 1), cell[2] + (i >> 2));
  return c;
}

V3d SdfGrid::to_grid(const V3d& p) const { return map_vector(world_to_grid_, p) + translation(world_to_grid_); }

Bounds3 SdfGrid::cell_bounds(uint32_t primitive) const {
  const auto [x, y, z] = cell_place(primitive);
  Bounds3 box;
  for (int i = 0; i < 8; ++i)
    box.extendBy(grid_to_world_.point(
        {static_cast<float>(x + (i & 1)), static_cast<float>(y + (i >> 1 & 1)), static_cast<float>(z + (i >> 2))}));
  return box;
}

double SdfGrid::intersect(const Vec3& origin, const Vec3& direction, uint32_t primitive) const {
  const V3d o = to_grid(V3d(origin)), d = map_vector(world_to_grid_, V3d(direction));
  const std::array<int, 3> cell = cell_place(primitive);
  // The same planes and the same products in both cells that share a face: they find the same t and the same point.
  double t_in = 0, t_out = kNever;
  int in_axis = -1, out_axis = -1;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = cell[static_cast<size_t>(axis)], high = low + 1;
    if (d[axis] == 0) {
      if (o[axis] < low || o[axis] > high) return kNever;
      continue;
    }
    const double t0 = ((d[axis] > 0 ? low : high) - o[axis]) / d[axis];
    const double t1 = ((d[axis] > 0 ? high : low) - o[axis]) / d[axis];
    if (t0 > t_in) t_in = t0, in_axis = axis;
    if (t1 < t_out) t_out = t1, out_axis = axis;
  }
  if (!(t_in < t_out)) return kNever;

  const Corners c = corners(cell);
  const V3d corner(cell[0], cell[1], cell[2]);
  const auto value = [&](double t, int face_axis, bool entering) {
    V3d p = o + d * t - corner;
    for (int axis = 0; axis < 3; ++axis) p[axis] = std::clamp(p[axis], 0.0, 1.0);
    if (face_axis >= 0) p[face_axis] = (d[face_axis] > 0) == entering ? 0 : 1;
    return trilerp(c, p);
  };
  const double length = t_out - t_in, f_in = value(t_in, in_axis, true), f_out = value(t_out, out_axis, false);
  const Cubic f(f_in, value(t_in + length / 3, -1, true), value(t_in + length * 2 / 3, -1, true), f_out);
  const bool inside = f_in < 0;
  double near = 0;
  for (const double far : {f.extrema()[0], f.extrema()[1], 1.0}) {
    const bool far_inside = far == 1 ? f_out < 0 : f(far) < 0;
    if (far_inside != inside) {
      const double t = t_in + length * find_crossing(f, near, far, inside);
      return t > 0 ? t : kNever;
    }
    if (far == 1) break;
    near = far;
  }
  return kNever;
}

SdfGrid::Local SdfGrid::eval(const V3d& grid) const {
  std::array<int, 3> cell;
  V3d within;
  for (int axis = 0; axis < 3; ++axis) {
    const int last = samples_.size[static_cast<size_t>(axis)] - 2;
    cell[static_cast<size_t>(axis)] = static_cast<int>(std::clamp(std::floor(grid[axis]), 0.0, double(last)));
    within[axis] = std::clamp(grid[axis] - cell[static_cast<size_t>(axis)], 0.0, 1.0);
  }
  const Corners c = corners(cell);
  return {trilerp(c, within), trilerp_gradient(c, within)};
}

V3d SdfGrid::smooth_gradient(const V3d& grid) const {
  const V3d steps(samples_.size[0] - 1, samples_.size[1] - 1, samples_.size[2] - 1);
  std::array<int, 3> cell;
  V3d within, lower, upper;  // lower, upper: derivatives across the cells on either side of the nearest sample
  for (int axis = 0; axis < 3; ++axis) {
    const double low = std::clamp(std::floor(grid[axis]), 0.0, steps[axis] - 1);
    cell[static_cast<size_t>(axis)] = static_cast<int>(low);
    within[axis] = std::clamp(grid[axis] - low, 0.0, 1.0);
  }
  // The interpolant where the other two coordinates are the point's and this one is a sample's.
  const auto on_plane = [&](size_t axis, int index) {
    const size_t b = (axis + 1) % 3, c = (axis + 2) % 3;
    const auto at = [&](int db, int dc) {
      std::array<int, 3> place = cell;
      place[axis] = std::clamp(index, 0, samples_.size[axis] - 1);
      place[b] += db, place[c] += dc;
      return sample(place[0], place[1], place[2]);
    };
    const double u = within[static_cast<int>(b)], v = within[static_cast<int>(c)];
    return lerp(lerp(at(0, 0), at(1, 0), u), lerp(at(0, 1), at(1, 1), u), v);
  };
  V3d upper_share;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<size_t>(axis);
    const int nearest = static_cast<int>(std::round(grid[axis]));
    const double middle = on_plane(a, nearest);
    lower[axis] = (middle - on_plane(a, nearest - 1)) * steps[axis];
    upper[axis] = (on_plane(a, nearest + 1) - middle) * steps[axis];
    // Below the first sample there is no cell. (Beyond the last one there is none either; its derivative counts as 0,
    // as in Mitsuba.)
    upper_share[axis] = nearest < 1 ? 1 : grid[axis] - nearest + 0.5;
  }
  V3d sum(0);
  for (int i = 0; i < 8; ++i) {
    V3d gradient;
    double weight = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const bool high = (i >> axis & 1) != 0;
      gradient[axis] = high ? upper[axis] : lower[axis];
      weight *= high ? upper_share[axis] : 1 - upper_share[axis];
    }
    if (weight > 0 && gradient.length2() > 0) sum += gradient.normalized() * weight;
  }
  return {sum.x / steps.x, sum.y / steps.y, sum.z / steps.z};
}

Vec3 SdfGrid::outward(const V3d& gradient) const {
  const double norm = gradient.length();
  const Vec3 normal = grid_to_world_.normal(norm > 0 ? Vec3(gradient * (1 / norm)) : Vec3(0, 0, 1));
  return normalize(flip_normals_ ? -normal : normal);
}

Vec3 SdfGrid::normal_at(const V3d& p) const { return outward(eval(to_grid(p)).gradient); }

SurfacePoint SdfGrid::surface_point(const Ray& ray, const Hit& hit) const {
  V3d p = to_grid(V3d(ray.origin) + V3d(ray.direction) * static_cast<double>(hit.t));
  // Rounding of t has moved the point off the level: two steps of Newton's method along the gradient take it back.
  Local at = eval(p);
  for (int i = 0; i < 2; ++i) {
    const double squared = at.gradient.length2();
    if (!(squared > 0)) break;
    const V3d step = at.gradient * (at.value / squared);
    constexpr double kFurthest = 0.01;  // of a cell: rounding is less; more would be another branch
    if (!(step.length2() < kFurthest * kFurthest)) break;
    p -= step;
    at = eval(p);
  }
  SurfacePoint s;
  s.primitive = hit.primitive;
  s.p = Vec3(map_vector(grid_to_world_, p) + translation(grid_to_world_));
  // The position's own rounding, and that of rays which start there.
  constexpr float kRoundings = 3;
  s.error = kRoundings * rounding_error(s.p);
  s.ng = outward(at.gradient);
  const Frame fallback(s.ng);
  s.dp_du = fallback.s;
  s.dp_dv = fallback.t;
  const Vec3 shading = normals_ == Normals::kSmooth ? bend_to_front(outward(smooth_gradient(p)), s.ng) : s.ng;
  s.shading = shading_frame(shading, s.dp_du);
  return s;
}

AreaSample SdfGrid::sample_area(const Vec2&) const { throw std::logic_error("an sdfgrid has no area to sample"); }

float SdfGrid::distance_bound(const Vec3& p, uint32_t primitive) const {
  const V3d q = to_grid(V3d(p));
  const std::array<int, 3> cell = cell_place(primitive);
  double squared = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = cell[static_cast<size_t>(axis)];
    squared += sqr(std::max({low - q[axis], q[axis] - low - 1, 0.0}));
  }
  return static_cast<float>(std::sqrt(squared) * least_stretch_ * (1 - 1e-7));  // the rounding must not raise it
}

RTCGeometry SdfGrid::make_embree_geometry(RTCDevice device) const { return make_user_geometry(device, this); }

}  // namespace turbid
