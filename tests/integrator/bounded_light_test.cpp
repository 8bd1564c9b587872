// Light of a table where the medium ends: against diffusion in a half-space, and against images set up by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "core/rng.h"
#include "core/warp.h"
#include "integrator/boundary_images.h"
#include "medium/henyey_greenstein.h"
#include "medium/isotropic.h"
#include "table/table_cache.h"
#include "testing/temporary_folder.h"

namespace turbid::testing {
namespace {

constexpr double kAlbedo = 0.9;

/// A medium with a mean free path of 1, and its table; made once per program.
const MultipleScattering& fog(float g) {
  static const TemporaryFolder folder;
  static std::map<float, std::unique_ptr<MultipleScattering>> made;
  std::unique_ptr<MultipleScattering>& result = made[g];
  if (!result) {
    const auto phase = std::make_shared<HenyeyGreensteinPhase>(g);
    TableRequest request;
    request.settings.deposits = 400'000;
    request.folder = folder.path().string();
    result = std::make_unique<MultipleScattering>(
        HomogeneousMedium(Spectrum(1.0f), Spectrum(static_cast<float>(kAlbedo)), phase), *find_table(*phase, request));
  }
  return *result;
}

/// Of isotropic scattering: albedo atanh(k) = k, by bisection.
double decay_of(double albedo) {
  double low = 1e-6, high = 1 - 1e-12;
  for (int i = 0; i < 100; ++i) {
    const double middle = (low + high) / 2;
    (albedo * std::atanh(middle) > middle ? high : low) = middle;
  }
  return low;
}

/// The line of images by four nodes of Gauss-Laguerre quadrature: places in extrapolations behind the mirrored one.
constexpr double kPlaces[] = {0.322547689619392, 1.745761101158347, 4.536620296921128, 9.395070912301133},
                 kShares[] = {0.603154104341634, 0.357418692437800, 0.038887908515005, 0.000539294705561};

/// What a half-space z < 0 leaves of the fluence exp(-k r)/r at x, of light that collides along a stretch, by the line
/// of images of phi + e dphi/dz = 0 at z = 0.
double half_space_share(const Stretch& light, const Vec3& x, double extrapolation, double k) {
  const auto fluence = [&](double px, double py, double pz) {
    const double r =
        std::hypot(static_cast<double>(x.x) - px, static_cast<double>(x.y) - py, static_cast<double>(x.z) - pz);
    return std::exp(-k * r) / r;
  };
  constexpr int kAlong = 40;
  double alone = 0, bounded = 0;
  for (int i = 0; i < kAlong; ++i) {
    // Collisions, evenly by their probability.
    const double caught = -std::expm1(-static_cast<double>(light.length));
    const Vec3 at = light.origin + light.direction * static_cast<float>(-std::log1p(-caught * (i + 0.5) / kAlong));
    const auto px = static_cast<double>(at.x), py = static_cast<double>(at.y), pz = static_cast<double>(at.z);
    alone += fluence(px, py, pz);
    double line = 0;
    for (size_t j = 0; j < 4; ++j) line += kShares[j] * fluence(px, py, -pz + extrapolation * kPlaces[j]);
    bounded += fluence(px, py, pz) + fluence(px, py, -pz) - 2 * line;
  }
  return bounded / alone;
}

BoundaryPlane plane_at(const Vec3& point, const Vec3& normal, double extrapolation) {
  return {point, normal, static_cast<float>(extrapolation)};
}

/// A boundary that reflects nothing: 2 A D with A = 1, D = 1/3.
constexpr double kExtrapolation = 2.0 / 3;

/// Light that depends on the distance from the collisions alone, the same in all directions and channels.
class RadialLight final : public ScatteredLight {
 public:
  using Fluence = double (*)(double);
  explicit RadialLight(Fluence fluence) : fluence_(fluence) {}
  float from_collision(const Vec3& x, const Vec3&, const Vec3&) const override {
    return static_cast<float>(fluence_(static_cast<double>(length(x))));
  }
  float from_stretch(const Vec3& x, const Vec3& axis, float depth, const Vec3& w) const override {
    constexpr int kAlong = 20;
    const float caught = -std::expm1(-depth);
    float sum = 0;
    for (int i = 0; i < kAlong; ++i)
      sum += from_collision(x + axis * std::log1p(-caught * (static_cast<float>(i) + 0.5f) / kAlong), axis, w) / kAlong;
    return caught * sum;
  }
  Lanes from_collision(const Vec3Lanes& x, const Vec3& axis, const Vec3& w) const override {
    return each(x, [&](const Vec3& one) { return from_collision(one, axis, w); });
  }
  Lanes from_stretch(const Vec3Lanes& x, const Vec3& axis, float depth, const Vec3& w) const override {
    return each(x, [&](const Vec3& one) { return from_stretch(one, axis, depth, w); });
  }

 private:
  template <class At>
  static Lanes each(const Vec3Lanes& x, const At& at) {
    LaneRow row;
    for (size_t i = 0; i < kLanes; ++i) row[i] = at({x.x[i], x.y[i], x.z[i]});
    return load_lanes(row);
  }
  Fluence fluence_;
};
MultipleScattering medium_of(RadialLight::Fluence fluence) {
  const HomogeneousMedium medium(Spectrum(1.0f), Spectrum(0.9f), std::make_shared<IsotropicPhase>());
  const auto light = std::make_shared<RadialLight>(fluence);
  return {medium, {light, light, light}};
}
double diffuse_fluence(double r) {
  static const double k = decay_of(kAlbedo);
  return std::exp(-k * r) / r;
}

/// The share that a half-space leaves, over that of diffusion, meant over places far from the source.
double half_space_ratio(const MultipleScattering& scattering, double extrapolation, double told) {
  const double k = decay_of(kAlbedo);
  const BoundaryPlanes planes = {plane_at({3, -5, 0}, {0, 0, 1}, extrapolation)};
  const Vec3 w(0, 0, 1);
  double found = 0, expected = 0;
  for (const float source_depth : {1.0f, 2.0f, 3.0f})
    for (const float depth : {0.3f, 1.0f, 2.0f, 4.0f})
      for (const float distance : {7.0f, 9.0f, 11.0f, 13.0f}) {
        const Stretch light{{0, 0, -source_depth}, normalize(Vec3(0.2f, 0.3f, -0.4f)), 1.5f};
        const Vec3 x(0.6f * distance, 0.8f * distance, -depth);
        const auto alone = static_cast<double>(scattering.source_radiance(light, x, w)[0]);
        found += static_cast<double>(bounded_source_radiance(scattering, light, planes, x, w)[0]) / alone;
        expected += half_space_share(light, x, told, k);
      }
  return found / expected;
}

// Two nodes in the place of the line of images are enough: the more the boundary reflects, the longer the line is.
TEST(BoundedLight, DiffuseInAHalfSpace) {
  EXPECT_NEAR(decay_of(kAlbedo), 0.5254, 1e-3);
  const MultipleScattering diffuse = medium_of(diffuse_fluence);
  for (const double factor : {1.0, 3.0, 6.0})
    EXPECT_NEAR(half_space_ratio(diffuse, factor * kExtrapolation, factor * kExtrapolation), 1, 0.004 * factor)
        << factor;
  EXPECT_GT(std::abs(half_space_ratio(diffuse, kExtrapolation, 1.1 * kExtrapolation) - 1), 0.015)
      << "another boundary is not noticed";
}

// Many mean free paths from the source the table's light is diffuse, and falls off as transport theory has it. What is
// left is the table's own noise, of which a small difference of sources and images has more.
TEST(BoundedLight, OfTheTableInAHalfSpaceIsThatOfDiffusion) {
  const double ratio = half_space_ratio(fog(0), kExtrapolation, kExtrapolation);
  std::printf("light left by a half-space, over that of diffusion: %.4f\n", ratio);
  EXPECT_NEAR(ratio, 1, 0.04);
  EXPECT_NEAR(half_space_ratio(fog(0), 5 * kExtrapolation, 5 * kExtrapolation), 1, 0.04) << "which reflects much";
  EXPECT_GT(std::abs(half_space_ratio(fog(0), kExtrapolation, 1.4 * kExtrapolation) - 1), 0.05)
      << "another boundary is not noticed";
}

/// The light of a stretch and its images by planes z = const and x = const (either may be missing: infinite).
struct Mirrors {
  float z = kInfinity, x = kInfinity;
};
double light_of_images(const MultipleScattering& scattering, const Stretch& light, const Mirrors& mirrors,
                       const Vec3& seen, const Vec3& w) {
  struct Image {
    float offset;  ///< beyond the mirrored place
    double weight;
    bool mirrored;
  };
  const auto images_by = [&](float plane) {
    std::vector<Image> images = {{0, 1, false}};
    if (!std::isfinite(plane)) return images;
    images.push_back({0, 1, true});
    for (size_t j = 0; j < 4; ++j)
      images.push_back({static_cast<float>(kExtrapolation * kPlaces[j]), -2 * kShares[j], true});
    return images;
  };
  double sum = 0;
  for (const Image& by_z : images_by(mirrors.z))
    for (const Image& by_x : images_by(mirrors.x)) {
      Stretch image = light;
      if (by_z.mirrored) {
        image.origin.z = 2 * mirrors.z - image.origin.z + by_z.offset;
        image.direction.z = -image.direction.z;
      }
      if (by_x.mirrored) {
        image.origin.x = 2 * mirrors.x - image.origin.x + by_x.offset;
        image.direction.x = -image.direction.x;
      }
      sum += by_z.weight * by_x.weight * static_cast<double>(scattering.source_radiance(image, seen, w)[0]);
    }
  return std::max(sum, 0.0);
}

// Near the source, scattering forwards, along any stretch: images one by one, their line by more nodes.
TEST(BoundedLight, OfOnePlaneIsThatOfItsImages) {
  const MultipleScattering& scattering = fog(0.3f);
  const BoundaryPlanes planes = {plane_at({7, -2, 0.5f}, {0, 0, 1}, kExtrapolation)};
  const auto ratio = [&](float told) {
    Rng rng(7);
    double found = 0, expected = 0;
    for (int i = 0; i < 300; ++i) {
      const auto inside = [&](float size) {
        const float x = rng.next_float() - 0.5f, y = rng.next_float() - 0.5f;
        return Vec3(size * x, size * y, 0.3f - 3 * rng.next_float());
      };
      const float u = rng.next_float();
      Vec3 direction = square_to_sphere({u, rng.next_float()});
      direction.z = -std::abs(direction.z);
      const float length = i % 3 == 0 ? kInfinity : 3 * rng.next_float();
      const Stretch light{inside(2), direction, length};
      const Vec3 seen = inside(5);
      const float v = rng.next_float();
      const Vec3 w = square_to_sphere({v, rng.next_float()});
      const auto alone = static_cast<double>(scattering.source_radiance(light, seen, w)[0]);
      found += static_cast<double>(bounded_source_radiance(scattering, light, planes, seen, w)[0]) / alone;
      expected += light_of_images(scattering, light, {.z = told}, seen, w) / alone;
    }
    return found / expected;
  };
  std::printf("light bounded by one plane, over that of images: %.4f\n", ratio(0.5f));
  EXPECT_NEAR(ratio(0.5f), 1, 0.006);
  EXPECT_GT(std::abs(ratio(0.6f) - 1), 0.012) << "a plane elsewhere is not noticed";
}

/// Light in the edge of a medium, z < 0 and x < 0, at that distance along it, over that of images and of images of
/// images. `added`, planted: what each plane takes away is added up.
double corner_ratio(const MultipleScattering& scattering, float distance, bool added = false) {
  const BoundaryPlane top = plane_at({0, 0, 0}, {0, 0, 1}, kExtrapolation),
                      side = plane_at({0, 0, 0}, {1, 0, 0}, kExtrapolation);
  const Vec3 w(0, 0, 1);
  double found = 0, expected = 0;
  for (const float depth : {0.5f, 1.5f, 3.0f})
    for (const float aside : {0.5f, 1.5f, 3.0f}) {
      const Stretch light{{-aside, 0, -2}, {0, 0.6f, -0.8f}, 1e-3f};
      const Vec3 x(-2, distance, -depth);
      const auto bounded = [&](const BoundaryPlanes& planes) {
        return static_cast<double>(bounded_source_radiance(scattering, light, planes, x, w)[0]);
      };
      const double alone = bounded({});
      found += (added ? bounded({top}) + bounded({side}) - alone : bounded({top, side})) / alone;
      expected += light_of_images(scattering, light, {.z = 0, .x = 0}, x, w) / alone;
    }
  return found / expected;
}

// A Gaussian of space is a product. So is exp(-k r)/r where images of images lie as far as is small against r:
// what is left of the difference falls like 1/(k r).
TEST(BoundedLight, OfPlanesAtRightAnglesIsThatOfImagesOfImages) {
  const MultipleScattering gaussian = medium_of([](double r) { return std::exp(-r * r / 32); });
  const MultipleScattering diffuse = medium_of(diffuse_fluence);
  std::printf("two planes over images of images: Gaussian %.4f, diffuse %.4f far and %.4f near, table %.4f near\n",
              corner_ratio(gaussian, 3), corner_ratio(diffuse, 60), corner_ratio(diffuse, 3), corner_ratio(fog(0), 3));
  EXPECT_NEAR(corner_ratio(gaussian, 3), 1, 0.003);
  EXPECT_NEAR(corner_ratio(diffuse, 12), 1, 0.08);
  EXPECT_NEAR(corner_ratio(diffuse, 60), 1, 0.035);
  EXPECT_NEAR(corner_ratio(diffuse, 3), 1, 0.1);
  EXPECT_NEAR(corner_ratio(fog(0), 3), 1, 0.1);
  EXPECT_GT(std::abs(corner_ratio(gaussian, 3, true) - 1), 0.1) << "planes added up";
}

// Whatever planes stand around, on whichever side the two ends lie.
TEST(BoundedLight, IsNeverBelowNothing) {
  const MultipleScattering& scattering = fog(0.3f);
  Rng rng(3);
  const auto somewhere = [&](float size) {
    const float u = rng.next_float();
    return square_to_sphere({u, rng.next_float()}) * (size * rng.next_float());
  };
  int brighter = 0, beyond = 0;
  for (int i = 0; i < 5000; ++i) {
    const Stretch light{somewhere(4), normalize(somewhere(1)), i % 5 == 0 ? kInfinity : 4 * rng.next_float()};
    const Vec3 x = somewhere(4), w = normalize(somewhere(1));
    BoundaryPlanes planes;
    const auto count = 1 + rng.next_u32() % 6;
    for (uint32_t p = 0; p < count; ++p) {
      add_boundary(plane_at(somewhere(3), normalize(somewhere(1)), 0.05 + 4 * static_cast<double>(rng.next_float())),
                   planes);
      const BoundaryPlane& last = planes.back();
      beyond += dot(x - last.point, last.normal) > 0 || dot(light.origin - last.point, last.normal) > 0;
    }
    const Spectrum bounded = bounded_source_radiance(scattering, light, planes, x, w);
    for (int c = 0; c < kChannels; ++c) {
      ASSERT_TRUE(std::isfinite(bounded[c])) << i;
      ASSERT_GE(bounded[c], 0) << i;
    }
    brighter += bounded[0] > scattering.source_radiance(light, x, w)[0];
  }
  EXPECT_GT(beyond, 1000);
  EXPECT_GT(brighter, 100) << "boundaries that reflect much give back more";
}

TEST(BoundedLight, SharesArePowers) {
  const MultipleScattering& scattering = fog(0.3f);
  const Stretch light{{0, 0, -1}, {0, 0.6f, -0.8f}, 2};
  const Vec3 x(2, 1, -0.5f), w(0, 0, 1);
  const auto bounded = [&](const BoundaryPlanes& planes) {
    return bounded_source_radiance(scattering, light, planes, x, w)[0];
  };
  BoundaryPlane plane = plane_at({0, 0, 0}, {0, 0, 1}, kExtrapolation);
  const float alone = scattering.source_radiance(light, x, w)[0], whole = bounded({plane});
  EXPECT_EQ(bounded({}), alone);
  EXPECT_LT(whole, 0.9f * alone);
  plane.share = 0;
  EXPECT_EQ(bounded({plane}), alone) << "counts nothing";
  plane.share = 0.5f;
  EXPECT_NEAR(bounded({plane}) / std::sqrt(alone * whole), 1, 1e-5f);
  // A place beyond the plane is as one on it.
  plane.share = 1;
  plane.point.z = -0.75f;
  BoundaryPlane touching = plane;
  touching.point.z = x.z;
  EXPECT_EQ(bounded({plane}), bounded({touching}));
}

}  // namespace
}  // namespace turbid::testing
