// Bump and normal maps, and blends: what they do to the material inside.
#include "surface/bsdf_checks.h"
#include "surface/bump_map.h"
#include "surface/materials.h"

namespace turbid::testing {
namespace {

constexpr auto kRadiance = TransportMode::kRadiance;
constexpr auto kImportance = TransportMode::kImportance;
constexpr TiltSettings kPlain{false, false};

BsdfPtr gold() {
  return std::make_shared<RoughConductor>(nullptr, nullptr, roughness(MicrofacetType::kGgx, 0.2f, 0.5f));
}

/// Height 0.3 u - 0.1 v, plus something that does not change.
class Slope final : public Texture {
 public:
  Spectrum eval(const SurfacePoint& p) const override { return Spectrum(5 + 0.3f * p.uv.x - 0.1f * p.uv.y); }
  Vec2 gradient(const SurfacePoint&) const override { return {0.3f, -0.1f}; }
  Spectrum mean() const override { return Spectrum(5.0f); }
  float max() const override { return 6; }
};

/// A point of a slanted plane: s and t are not the partial derivatives.
SurfacePoint slanted_point() {
  SurfacePoint p;
  p.p = Vec3(1, 2, 3);
  p.ng = normalize(Vec3(1, 2, 2));
  p.dp_du = Vec3(2, -1, 0);
  p.dp_dv = cross(p.ng, p.dp_du) * 0.5f;
  p.shading.n = p.ng;
  p.shading.s = normalize(p.dp_du);
  p.shading.t = cross(p.ng, p.shading.s);
  p.uv = Vec2(0.4f, 0.7f);
  return p;
}

TEST(NormalMap, OfTheShadingNormalChangesNothing) {
  const NormalMap flat(constant(0.5f, 0.5f, 1), gold());
  const BsdfPtr nested = gold();
  const SurfacePoint point = slanted_point();
  Rng rng(1);
  for (int i = 0; i < 100; ++i) {
    const Vec3 given = direction(2 * rng.next_double() - 1, 6 * rng.next_double());
    const Vec3 chosen = direction(2 * rng.next_double() - 1, 6 * rng.next_double());
    for (const TransportMode mode : {kRadiance, kImportance}) {
      const Bsdf::Eval a = flat.eval(point, given, chosen, mode), b = nested->eval(point, given, chosen, mode);
      EXPECT_NEAR(a.value[0], b.value[0], 1e-5f * b.value[0]);
      EXPECT_NEAR(a.pdf_w, b.pdf_w, 1e-5f * b.pdf_w);
    }
  }
}

TEST(NormalMap, IsTheMaterialInATurnedFrame) {
  const Vec3 n = normalize(Vec3(0.3f, -0.2f, 0.9f));
  const NormalMap tilted(normal_color(n), gold(), kPlain);
  const Vec3 s = normalize(Vec3(1, 0, 0) - n * n.x);
  const Frame frame(s, cross(n, s), n);
  const SurfacePoint point = slanted_point();
  const Vec3 given = direction(0.7, 0.3), chosen = direction(0.6, 4);
  const Bsdf::Eval inside = gold()->eval(point, frame.to_local(given), frame.to_local(chosen), kRadiance);
  const Bsdf::Eval outside = tilted.eval(point, given, chosen, kRadiance);
  EXPECT_NEAR(outside.value[0], inside.value[0], 1e-5f);
  EXPECT_NEAR(outside.pdf_w, inside.pdf_w, 1e-5f);
  const auto sample = tilted.sample(point, given, 0.3f, Vec2(0.2f, 0.6f), kRadiance);
  const auto nested = gold()->sample(point, frame.to_local(given), 0.3f, Vec2(0.2f, 0.6f), kRadiance);
  ASSERT_TRUE(sample && nested);
  EXPECT_LT(length(sample->direction - frame.to_world(nested->direction)), 1e-6f);
}

TEST(NormalMap, NothingPassesWhereTheNormalsDisagree) {
  const NormalMap tilted(normal_color({0.8f, 0, 0.6f}), std::make_shared<Diffuse>(nullptr), kPlain);
  const SurfacePoint point = slanted_point();
  const Vec3 behind = direction(0.1, std::numbers::pi), before = direction(0.8, 0);
  EXPECT_TRUE(tilted.eval(point, behind, before, kRadiance).value.is_black());
  EXPECT_TRUE(tilted.eval(point, before, behind, kRadiance).value.is_black());
  EXPECT_FALSE(tilted.sample(point, behind, 0.1f, Vec2(0.5f), kRadiance));
}

TEST(NormalMap, TurnsTheNormalTowardsTheSensor) {
  const Vec3 n = normalize(Vec3(0.8f, 0, 0.6f));
  const auto diffuse = std::make_shared<Diffuse>(constant(1));
  const NormalMap tilted(normal_color(n), diffuse, {true, false});
  const SurfacePoint point = slanted_point();
  // Seen from behind n, the normal is its mirror image about z.
  const Vec3 behind = direction(0.1, std::numbers::pi), chosen = direction(0.9, 2);
  const float expected = dot(chosen, Vec3(-n.x, 0, n.z)) * kInvPi;
  EXPECT_NEAR(tilted.eval(point, behind, chosen, kRadiance).value[0], expected, 1e-6f);
  EXPECT_NEAR(tilted.eval(point, direction(0.9, 1), chosen, kRadiance).value[0], dot(chosen, n) * kInvPi, 1e-6f);
}

TEST(NormalMap, SoftensTheShadowsEdge) {
  // Estevez et al. 2019: alpha^2 = tan^2(n) / 8, S = 2 / (1 + sqrt(1 + alpha^2 tan^2(wi))).
  const auto diffuse = std::make_shared<Diffuse>(constant(1));
  const TexturePtr color = normal_color({0.5f, 0, 0.8f});
  const NormalMap hard(color, diffuse, kPlain), soft(color, diffuse, {false, true});
  const SurfacePoint point = slanted_point();
  const Vec3 given = direction(0.9, 1), wi = direction(0.3, 0.5);
  const double tan_n = 0.5 / 0.8, tan_wi = std::sqrt(1 - 0.09) / 0.3;
  const double s = 2 / (1 + std::sqrt(1 + tan_n * tan_n / 8 * tan_wi * tan_wi));
  EXPECT_NEAR(double(soft.eval(point, given, wi, kRadiance).value[0]),
              s * double(hard.eval(point, given, wi, kRadiance).value[0]), 1e-6);
}

TEST(BumpMap, HasTheNormalOfTheDisplacedSurface) {
  const SurfacePoint point = slanted_point();
  const float scale = 0.7f;
  // p + scale h n, with h = 0.3 u - 0.1 v.
  const Vec3 du = point.dp_du + point.ng * (scale * 0.3f), dv = point.dp_dv - point.ng * (scale * 0.1f);
  const Vec3 n = point.to_local(normalize(cross(du, dv)));
  ASSERT_GT(n.z, 0);
  const BumpMap bump(std::make_shared<Slope>(), scale, gold());
  const NormalMap normal(normal_color(n), gold());
  for (const TransportMode mode : {kRadiance, kImportance}) {
    const Vec3 given = direction(0.7, 0.3), chosen = direction(0.6, 4);
    const Bsdf::Eval a = bump.eval(point, given, chosen, mode), b = normal.eval(point, given, chosen, mode);
    EXPECT_NEAR(a.value[0], b.value[0], 1e-4f * b.value[0]);
    EXPECT_NEAR(a.pdf_w, b.pdf_w, 1e-4f * b.pdf_w);
  }
  const BumpMap flat(constant(3), scale, gold());
  EXPECT_NEAR(flat.eval(point, direction(0.7), direction(0.6), kRadiance).value[0],
              gold()->eval(point, direction(0.7), direction(0.6), kRadiance).value[0], 1e-5f);
}

/// Delta lobes in both modes: a tilted mirror sends radiance and importance along the same paths with adjoint weights.
TEST(Tilted, MirrorReflectsAboutTheTiltedNormal) {
  const Vec3 n = normalize(Vec3(0.2f, 0.1f, 0.9f));
  const NormalMap mirror(normal_color(n), std::make_shared<Conductor>(nullptr, nullptr), {true, false});
  const SurfacePoint point = slanted_point();
  const Vec3 wo = direction(0.8, 2), wi = n * (2 * dot(wo, n)) - wo;
  const auto radiance = mirror.sample(point, wo, 0.99f, Vec2(0.5f), kRadiance);
  ASSERT_TRUE(radiance);
  EXPECT_LT(length(radiance->direction - wi), 1e-5f);
  EXPECT_EQ(radiance->weight, Spectrum(1.0f));
  // Backwards: |cos wo / cos' wo| |cos' wi / cos wi|, over the probability of the frame.
  const auto importance = mirror.sample(point, wi, 0.99f, Vec2(0.5f), kImportance);
  ASSERT_TRUE(importance);
  EXPECT_LT(length(importance->direction - wo), 1e-5f);
  const float prob = 1 - 0.5f * std::sqrt(1 - sqr(n.z));
  EXPECT_NEAR(importance->weight[0], wo.z / wi.z / prob, 1e-4f);
}

TEST(Tilted, LetsNullLobesPassStraight) {
  const NormalMap holes(normal_color({0.3f, 0.1f, 0.9f}),
                        std::make_shared<Mask>(constant(0.25f), std::make_shared<Diffuse>(nullptr)));
  const SurfacePoint point = slanted_point();
  for (const Vec3& given : {direction(0.7), direction(-0.7), direction(0.05, 3.5)}) {
    EXPECT_EQ(holes.null_transmission(point, given), Spectrum(0.75f));
    const auto sample = holes.sample(point, given, 0.9f, Vec2(0.5f), kRadiance);
    ASSERT_TRUE(sample);
    EXPECT_EQ(sample->direction, -given);
    EXPECT_EQ(sample->weight, Spectrum(1.0f));
    EXPECT_EQ(sample->pdf_w, 0);
  }
}

TEST(Blend, WeighsBothMaterials) {
  const SurfacePoint point = slanted_point();
  const auto white = std::make_shared<Diffuse>(constant(1)), dark = std::make_shared<Diffuse>(constant(0.2f));
  const Blend blend(constant(0.75f), white, dark);
  EXPECT_NEAR(blend.eval(point, direction(0.5), direction(0.8), kRadiance).value[0], 0.4f * 0.8f * kInvPi, 1e-6f);
  EXPECT_NEAR(blend.albedo(point)[0], 0.4f, 1e-6f);
  const Blend all(constant(2), white, dark), none(constant(-1), white, dark);
  EXPECT_EQ(all.albedo(point), Spectrum(0.2f));
  EXPECT_EQ(none.albedo(point), Spectrum(1.0f));
}

/// Mirrors and holes keep their share.
TEST(Blend, KeepsDeltaLobes) {
  const SurfacePoint point = slanted_point();
  const Blend blend(constant(0.3f), std::make_shared<NullBsdf>(), std::make_shared<Conductor>(nullptr, nullptr));
  EXPECT_NEAR(blend.null_transmission(point, direction(0.5))[0], 0.7f, 1e-6f);
  const auto mirrored = blend.sample(point, direction(0.5), 0.29f, Vec2(0.5f), kRadiance);
  const auto passed = blend.sample(point, direction(0.5), 0.31f, Vec2(0.5f), kRadiance);
  ASSERT_TRUE(mirrored && passed);
  EXPECT_EQ(mirrored->flags, lobe::kReflection | lobe::kDelta);
  EXPECT_TRUE(passed->flags & lobe::kNull);
  EXPECT_EQ(mirrored->weight, Spectrum(1.0f));
  EXPECT_EQ(passed->weight, Spectrum(1.0f));
}

TEST(Tilted, RefusesToStandAlone) {
  EXPECT_THROW(NormalMap(constant(1), nullptr), std::invalid_argument);
  EXPECT_THROW(BumpMap(constant(1), 1, nullptr), std::invalid_argument);
  EXPECT_THROW(Blend(nullptr, std::make_shared<NullBsdf>(), nullptr), std::invalid_argument);
}

}  // namespace
}  // namespace turbid::testing
