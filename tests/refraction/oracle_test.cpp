// RefractiveScattering::gather against integrals that know the geometry: a slab, where paths are a matter of one
// dimension, and a ball, where rings of light are.
#include <gtest/gtest.h>

#include <numbers>

#include "refraction/distance_factor.h"
#include "refraction/refractive_scattering.h"
#include "scene/loader.h"
#include "surface/fresnel.h"

namespace turbid::testing {
namespace {

constexpr double kEta = 1.4, kSigma = 0.6, kAlbedo = 0.8, kIntensity = 5;

std::string scene_text(const std::string& shape, const std::string& light, bool inside_out = false) {
  const std::string filled = R"(<medium name=")" + std::string(inside_out ? "exterior" : "interior") +
                             R"(" type="homogeneous"><rgb name="sigma_t" value="0.6"/><rgb name="albedo" value="0.8"/>
                             </medium>)";
  return R"(<scene version="3.0.0"><integrator type="volpath"/><sensor type="perspective"/>)" + light + shape +
         R"(<bsdf type="dielectric"><float name="int_ior" value="1.4"/><float name="ext_ior" value="1"/></bsdf>)" +
         filled + "</shape></scene>";
}

/// The mean of gather() over many streams, and its standard error.
std::pair<double, double> gather(const Scene& scene, const Ray& flight, const RefractiveSettings& settings, int count) {
  const RefractiveScattering scattering(scene, settings);
  Sampler sampler(SamplerKind::kIndependent, 3);
  SampleCounters counters;
  double sum = 0, squares = 0;
  for (int i = 0; i < count; ++i) {
    sampler.start(0, static_cast<uint64_t>(i));
    const auto value = static_cast<double>(
        scattering.gather(flight, *scene.media().front().medium, Spectrum(1.0f), sampler, counters).mean());
    sum += value;
    squares += sqr(value);
  }
  const double mean = sum / count;
  return {mean, std::sqrt(std::max(0.0, squares / count - sqr(mean)) / (count - 1))};
}

Scene load(const std::string& xml) { return Scene(std::move(load_scene_from_string(xml, "oracle", {}).parts)); }

double fresnel_transmission(double cos_light, double eta) {
  return 1 -
         static_cast<double>(fresnel_dielectric(static_cast<float>(cos_light), static_cast<float>(eta)).reflectance);
}

/// What a collision at distance t makes of the fluence there, after a way of length s in the medium.
double scattered(double fluence, double t, double s) {
  return fluence * kSigma * kAlbedo / (4 * std::numbers::pi) * std::exp(-kSigma * (t + s));
}

/// The smaller root of a function that falls from `low` to `high`.
template <class Function>
double bisect(const Function& f, double low, double high) {
  for (int i = 0; i < 200; ++i) {
    const double middle = (low + high) / 2;
    (f(middle) > 0 ? low : high) = middle;
  }
  return (low + high) / 2;
}

/// Below the plane z = 0, light at height h over it: fluence at depth z and horizontal distance x, and the way to
/// there.
using SlabFluence = std::pair<double, double> (*)(double h, double x, double z, double eta);

/// The sine of the angle of incidence whose ray arrives: h tan(i) + z tan(r) = x.
double slab_sine(double h, double x, double z, double eta) {
  const auto arrives = [&](double sine) {
    const double sine_r = sine / eta;
    return h * sine / std::sqrt(1 - sqr(sine)) + z * sine_r / std::sqrt(1 - sqr(sine_r));
  };
  return bisect([&](double s) { return x - arrives(s); }, 0, std::min(1.0, eta) * (1 - 1e-15));
}

std::pair<double, double> slab_fluence(double h, double x, double z, double eta) {
  const double sine = slab_sine(h, x, z, eta);
  const double cos_l = std::sqrt(1 - sqr(sine)), cos_v = std::sqrt(1 - sqr(sine / eta));
  const double d = flat_distance_factor(z / cos_v, h / cos_l, cos_v, cos_l, eta);
  return {sqr(eta) * kIntensity * fresnel_transmission(cos_l, eta) / d, z / cos_v};
}

/// The boundary bends light, but light falls with the square of the way.
std::pair<double, double> unfocused_fluence(double h, double x, double z, double eta) {
  const double sine = slab_sine(h, x, z, eta);
  const double cos_l = std::sqrt(1 - sqr(sine)), cos_v = std::sqrt(1 - sqr(sine / eta));
  return {kIntensity * fresnel_transmission(cos_l, eta) / sqr(z / cos_v + h / cos_l), z / cos_v};
}

/// The boundary only reflects.
std::pair<double, double> straight_fluence(double h, double x, double z, double eta) {
  const double distance = std::hypot(h + z, x), cosine = (h + z) / distance;
  return {kIntensity * fresnel_transmission(cosine, eta) / sqr(distance), z / cosine};
}

const std::string kSlab =
    R"(<shape type="cube"><transform name="to_world"><scale x="20" y="20" z="1"/><translate z="-1"/></transform>)";

std::string point_light(const std::string& position) {
  return R"(<emitter type="point"><point name="position" value=")" + position +
         R"("/><rgb name="intensity" value="5"/></emitter>)";
}

double slab_integral(double h, double from_x, double depth, double length, SlabFluence at = slab_fluence) {
  constexpr int kSteps = 4000;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double t = length * (i + 0.5) / kSteps;
    const auto [fluence, s] = at(h, std::abs(from_x + t), depth, kEta);
    sum += scattered(fluence, t, s) * length / kSteps;
  }
  return sum;
}

TEST(RefractiveScatteringOracle, SlabUnderAPointLight) {
  const Scene scene = load(scene_text(kSlab, point_light("0, 0, 1.2")));
  const Ray flight{Vec3(-1.5f, 0, -0.7f), Vec3(1, 0, 0), 4};
  const double exact = slab_integral(1.2, -1.5, 0.7, 4);
  const auto [mean, error] = gather(scene, flight, {.samples = 16}, 2000);
  EXPECT_NEAR(mean, exact, 5 * error + 1e-4 * exact);
  EXPECT_LT(error, 0.005 * exact);
  // What the wrong ways to shade leave out is what they say, and shows.
  const auto expect_other = [&](const RefractiveSettings& settings, SlabFluence fluence) {
    const double other = slab_integral(1.2, -1.5, 0.7, 4, fluence);
    const auto [found, other_error] = gather(scene, flight, settings, 2000);
    EXPECT_NEAR(found, other, 5 * other_error + 1e-4 * other);
    EXPECT_GT(std::abs(other - exact), 20 * other_error);
  };
  expect_other({.samples = 16, .focusing = false}, unfocused_fluence);
  expect_other({.method = RefractiveMethod::kStraightLine, .samples = 64}, straight_fluence);
}

/// In a ball of radius 1, light on its axis at distance a: fluence at the point (z along the axis towards the light,
/// rho across), summed over the rings of light that arrive, and the ways within, as in-scattering at t.
double ball_scattering(double a, double z, double rho, double t) {
  // A ring leaves the light at an angle alpha, arrives at the ball at polar angle phi and goes on straight.
  const auto ray_at = [&](double phi) {
    const double px = std::cos(phi), py = std::sin(phi);
    const double lx = a - px, ly = -py, distance = std::hypot(lx, ly);
    const double cos_l = (lx * px + ly * py) / distance;
    struct {
      double px, py, dx, dy, alpha, cos_l;
    } ray{px, py, 0, 0, std::atan2(py, a - px), cos_l};
    const double cos_t = std::sqrt(1 - (1 - sqr(cos_l)) / sqr(kEta)), bend = cos_l / kEta - cos_t;
    ray.dx = px * bend - lx / (distance * kEta);
    ray.dy = py * bend - ly / (distance * kEta);
    return ray;
  };
  // Signed distance of the point to the ray, in the plane of the axis; both sides of the axis can send light there.
  const auto miss = [&](double phi) {
    const auto ray = ray_at(phi);
    return ray.dx * (rho - ray.py) - ray.dy * (z - ray.px);
  };
  const double last = std::acos(1 / a) - 1e-9;  // the horizon
  constexpr int kCells = 400;
  double sum = 0;
  for (int i = 0; i < kCells; ++i) {
    double low = -last + 2 * last * i / kCells, high = -last + 2 * last * (i + 1) / kCells;
    if (miss(low) * miss(high) > 0) continue;
    const bool falls = miss(low) > 0;
    const double phi = bisect([&](double x) { return falls ? miss(x) : -miss(x); }, low, high);
    const auto ray = ray_at(phi);
    const double s = ray.dx * (z - ray.px) + ray.dy * (rho - ray.py);
    if (s <= 0) continue;
    constexpr double kStep = 1e-6;
    const double dn = std::abs(miss(phi + kStep) - miss(phi - kStep)),
                 da = std::abs(ray_at(phi + kStep).alpha - ray_at(phi - kStep).alpha);
    const double fluence =
        kIntensity * fresnel_transmission(ray.cos_l, kEta) * std::abs(std::sin(ray.alpha)) * da / (rho * dn);
    sum += scattered(fluence, t, s);
  }
  return sum;
}

TEST(RefractiveScatteringOracle, BallUnderAPointLight) {
  const Scene scene = load(scene_text(
      R"(<shape type="generated"><string name="kind" value="icosphere"/><float name="radius" value="1"/>
         <integer name="subdivisions" value="5"/>)",
      point_light("0, 0, 2.5")));
  // Off the axis, where there are no caustics but those that the flight crosses.
  const Vec3 from(0.3f, -0.7f, 0.25f), to(0.2f, 0.75f, -0.1f);
  const Ray flight{from, normalize(to - from), length(to - from)};
  constexpr int kSteps = 3000;
  double exact = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double t = static_cast<double>(flight.t_max) * (i + 0.5) / kSteps;
    const Vec3 v = flight.at(static_cast<float>(t));
    exact += ball_scattering(2.5, static_cast<double>(v.z), static_cast<double>(std::hypot(v.x, v.y)), t) *
             static_cast<double>(flight.t_max) / kSteps;
  }
  const auto [mean, error] = gather(scene, flight, {}, 100);
  EXPECT_NEAR(mean / exact, 1, 5 * error / exact + 2e-3) << "triangles with smooth normals are no ball: a little off";
  EXPECT_LT(error, 0.01 * exact);
  const auto [points, points_error] =
      gather(scene, flight, {.method = RefractiveMethod::kPointSampling, .samples = 16}, 100);
  EXPECT_NEAR(points / exact, 1, 5 * points_error / exact + 2e-3);
}

TEST(RefractiveScatteringOracle, LightInsideTheSlab) {
  // Fog above z = 0, the light below it: index ratio below 1.
  const Scene scene = load(scene_text(kSlab, point_light("0, 0, -0.8"), true));
  const Ray flight{Vec3(-1.2f, 0, 0.6f), Vec3(1, 0, 0), 3};
  constexpr int kSteps = 4000;
  double exact = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double t = 3.0 * (i + 0.5) / kSteps;
    const auto [fluence, s] = slab_fluence(0.8, std::abs(-1.2 + t), 0.6, 1 / kEta);
    exact += scattered(fluence, t, s) * 3.0 / kSteps;
  }
  const auto [mean, error] = gather(scene, flight, {.samples = 16}, 2000);
  EXPECT_NEAR(mean, exact, 5 * error + 1e-4 * exact);
  EXPECT_LT(error, 0.005 * exact);
}

}  // namespace
}  // namespace turbid::testing
