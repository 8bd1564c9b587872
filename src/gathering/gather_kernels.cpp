#include "gathering/gather_kernels.h"

#include "path/passage.h"

namespace turbid {
namespace {

Imath::V3d wide(const Vec3& v) { return Imath::V3d(v); }

/// int_0^x e^-s ds / x.
double mean_of_decay(double x) { return std::abs(x) < 1e-8 ? 1 - x / 2 : -std::expm1(-x) / x; }

}  // namespace

Chord chord_in(const Ray& ray, const GatherVolume& cylinder) {
  // In double precision: radii are small against distances.
  const Imath::V3d axis = wide(cylinder.direction), d = wide(ray.direction),
                   w = wide(ray.origin) - wide(cylinder.origin);
  const double cosine = d.dot(axis), along = w.dot(axis), radius = static_cast<double>(cylinder.radius);
  Chord chord{0, static_cast<double>(ray.t_max)};
  const auto cut = [&](double from, double to) {
    chord.from = std::max(chord.from, from);
    chord.to = std::min(chord.to, to);
  };
  const Imath::V3d across = d - axis * cosine, offset = w - axis * along;
  const double a = across.dot(across), b = across.dot(offset), c = offset.dot(offset) - radius * radius;
  constexpr double kParallel = 1e-14;
  if (a < kParallel) {
    if (c >= 0) return {};
  } else {
    const double discriminant = b * b - a * c;
    if (discriminant <= 0) return {};
    const double root = std::sqrt(discriminant);
    cut((-b - root) / a, (-b + root) / a);
  }
  const double length = static_cast<double>(cylinder.length);
  if (std::abs(cosine) < kParallel) return along >= 0 && along < length ? chord : Chord{};
  const double first = -along / cosine, second = (length - along) / cosine;
  cut(std::min(first, second), std::max(first, second));
  return chord;
}

Spectrum weight_along(const GatherVolume& cylinder, float distance, bool long_cylinder,
                      const HomogeneousMedium& medium) {
  const Spectrum passed = medium.transmittance(distance);
  if (long_cylinder) return passed;
  return medium.is_grey() ? Spectrum(1.0f) : passed / (channel_mix(cylinder.weight) * passed).sum();
}

Spectrum flux_through(const LightSegment& segment, const GatherVolume& cylinder, const Chord& chord, bool long_cylinder,
                      const HomogeneousMedium& medium, float u) {
  const double length = chord.to - chord.from;
  const double along =
      static_cast<double>(dot(segment.ray.origin - cylinder.origin, cylinder.direction) + cylinder.start);
  const double cosine = static_cast<double>(dot(segment.ray.direction, cylinder.direction));
  const bool closed = medium.is_grey() || (long_cylinder && segment.is_long);
  if (!closed) {
    const double at = chord.from + static_cast<double>(u) * length;
    return segment.flux_at(static_cast<float>(at), medium) *
           weight_along(cylinder, static_cast<float>(std::max(0.0, along + at * cosine)), long_cylinder, medium) *
           static_cast<float>(length);
  }
  // The optical depth is sigma (constant + slope t).
  const double constant = long_cylinder ? along : 0;
  const double slope = (long_cylinder ? cosine : 0) + (segment.is_long ? 1 : 0);
  Spectrum result;
  for (int c = 0; c < kChannels; ++c) {
    const double sigma = static_cast<double>(medium.sigma_t()[c]);
    result[c] = static_cast<float>(std::exp(-sigma * (constant + slope * chord.from)) * length *
                                   mean_of_decay(sigma * slope * length));
  }
  return result * segment.flux;
}

}  // namespace turbid
