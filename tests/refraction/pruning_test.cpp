// What is left out before a contour is looked for: bounds of eight sets of triangles, and the filter of eight
// triangles.
#include <gtest/gtest.h>

#include "geometry/generated.h"
#include "refraction/position_normal_tree.h"
#include "refraction/random_facets.h"
#include "refraction/triangle_filter.h"

namespace turbid::testing {
namespace {

/// A unit vector within `angle` of an axis.
V3d within(RandomFacets& random, const V3d& axis, double angle) {
  const double cosine = random.uniform(std::cos(angle), 1), sine = std::sqrt(1 - sqr(cosine));
  const V3d across = axis.cross(random.direction()).normalized();
  return (axis * cosine + across * sine).normalized();
}

struct Refracted {
  V3d p, w;
};

/// A point of the ball and a normal of the cone that refract the light of a point, as vectors have it; light that
/// arrives from behind the normal or is reflected as a whole gives none.
std::optional<Refracted> refract_somewhere(const BoundedNormals& bounds, size_t k, const RefractionQuery& query,
                                           RandomFacets& random) {
  const auto row = [k](const float lanes[3][BoundedNormals::kLanes]) {
    return V3d(Vec3(lanes[0][k], lanes[1][k], lanes[2][k]));
  };
  const V3d p = row(bounds.center) +
                random.direction() * (static_cast<double>(bounds.radius[k]) * std::cbrt(random.uniform(0, 1)));
  const V3d n = within(random, row(bounds.axis), static_cast<double>(bounds.angle[k])) * query.sign;
  const V3d l = query.light.at_infinity ? query.light.place : (query.light.place - p).normalized();
  const double cos_l = l.dot(n), cos2 = 1 - (1 - sqr(cos_l)) / sqr(query.eta);
  if (cos_l <= 0 || cos2 <= 0) return std::nullopt;
  return Refracted{p, n * (cos_l / query.eta - std::sqrt(cos2)) - l / query.eta};
}

TEST(RefractedReach, HoldsAllThatIsRefracted) {
  RandomFacets random(21);
  size_t asked = 0, found = 0, left_out = 0, others = 0;
  for (int i = 0; i < 4000; ++i) {
    BoundedNormals bounds;
    const double size = std::pow(10.0, random.uniform(-4, 0)), opening = std::pow(10.0, random.uniform(-4, 0));
    for (size_t k = 0; k < BoundedNormals::kLanes; ++k) {
      const V3d center = random.direction() * random.uniform(0, 1), axis = random.direction();
      for (int c = 0; c < 3; ++c) {
        bounds.center[c][k] = static_cast<float>(center[c]);
        bounds.axis[c][k] = static_cast<float>(axis[c]);
      }
      bounds.radius[k] = static_cast<float>(size);
      bounds.angle[k] = static_cast<float>(opening);
    }
    const LightPoint light{random.direction() * (i % 3 == 0 ? 1 : random.uniform(0.5, 3)), i % 3 == 0};
    const RefractionQuery query(light, i % 2 == 0 ? 1.4 : 1 / 1.4, i % 5 < 2);
    for (size_t k = 0; k < BoundedNormals::kLanes; ++k) {
      const auto refracted = refract_somewhere(bounds, k, query, random);
      if (!refracted) continue;
      const double t = random.uniform(0, 3);
      const V3d direction = random.direction(), v = refracted->p + refracted->w * random.uniform(0, 4);
      const RefractedReach reach = refracted_reach(bounds, query, {v - direction * t, direction}, 0, 3);
      ++asked;
      // Normals and places that float has rounded may lie outside by a little of the body's size.
      constexpr double kRounding = 1e-5;
      found += (reach.lanes >> k & 1) && reach.from[k] - kRounding <= t && t <= reach.to[k] + kRounding;
      for (size_t other = 0; other < BoundedNormals::kLanes; ++other) left_out += !(reach.lanes >> other & 1);
      others += BoundedNormals::kLanes - 1;
    }
  }
  EXPECT_GT(asked, 8000u);
  EXPECT_EQ(found, asked);
  EXPECT_GT(left_out, others / 2) << "bounds that hold everything say nothing";
}

TEST(TriangleFilter, KeepsWhatHasAContour) {
  RandomFacets random(22);
  ContourFinder finder;
  for (const bool smooth : {true, false})
    for (const bool light_inside : {false, true}) {
      MeshData data = make_bumpy_sphere(1, 0.2f, 3, 1, 2);
      if (!smooth) data.normals.clear();
      const TriangleMesh mesh(data);
      size_t with_contour = 0, kept = 0;
      for (int i = 0; i < 200; ++i) {
        const bool at_infinity = i % 4 == 0 && !light_inside;
        const LightPoint light{random.direction() * (at_infinity ? 1 : light_inside ? 0.3 : 2), at_infinity};
        const double reach = light_inside ? 2 : 0.7;
        const V3d from = random.direction() * reach, to = random.direction() * reach;
        const Segment segment{{from, (to - from).normalized()}, 0, (to - from).length()};
        const double eta = light_inside ? 1 / 1.4 : 1.4;
        const TriangleFilter filter(mesh, light, eta, light_inside, segment);
        std::vector<uint32_t> triangles;
        for (uint32_t first = 0; first < mesh.triangle_count(); first += static_cast<uint32_t>(triangles.size())) {
          triangles.clear();
          const auto count = 1 + static_cast<uint32_t>(random.uniform(0, 7.999));  // any number of lanes
          for (uint32_t k = first; k < first + count && k < mesh.triangle_count(); ++k) triangles.push_back(k);
          const uint32_t lanes = filter.may_contribute(triangles);
          ASSERT_EQ(lanes >> triangles.size(), 0u);
          for (size_t k = 0; k < triangles.size(); ++k) {
            const Facet outward = facet_of(mesh, triangles[k]), facet = light_inside ? outward.flipped() : outward;
            const Pencil pencil(facet, light, eta);
            const bool lit = (light.at_infinity ? light.place : light.place - facet.p0).dot(facet.ng) > 0;
            const bool passed = lanes >> k & 1, contour = lit && !finder.find(pencil, segment).empty();
            EXPECT_TRUE(passed || !contour) << "triangle " << triangles[k] << " of ray " << i;
            with_contour += contour;
            kept += passed;
          }
        }
      }
      EXPECT_GT(with_contour, 500u);
      EXPECT_LT(kept, 3 * with_contour) << "a filter that lets everything pass is none";
    }
}

}  // namespace
}  // namespace turbid::testing
