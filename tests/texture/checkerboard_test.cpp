#include "texture/checkerboard.h"

#include <gtest/gtest.h>

#include "texture/constant.h"

namespace turbid {
namespace {

SurfacePoint at(float u, float v) {
  SurfacePoint point;
  point.uv = Vec2(u, v);
  return point;
}
TexturePtr grey(float v) { return std::make_shared<ConstantTexture>(v); }

TEST(Checkerboard, AlternatesByHalves) {
  const CheckerboardTexture board(grey(0.9f), grey(0.1f));
  EXPECT_EQ(board.eval(at(0.2f, 0.2f)), Spectrum(0.9f));
  EXPECT_EQ(board.eval(at(0.7f, 0.2f)), Spectrum(0.1f));
  EXPECT_EQ(board.eval(at(0.2f, 0.7f)), Spectrum(0.1f));
  EXPECT_EQ(board.eval(at(0.7f, 0.7f)), Spectrum(0.9f));
  EXPECT_EQ(board.eval(at(-0.2f, 3.2f)), Spectrum(0.1f));  // fractional parts 0.8 and 0.2
  EXPECT_EQ(board.eval_scalar(at(0.7f, 0.2f)), 0.1f);
  EXPECT_EQ(board.max(), 0.9f);
  EXPECT_NEAR(board.mean()[0], 0.5f, 1e-6f);
  EXPECT_FALSE(board.is_constant());
}

TEST(Checkerboard, HasMitsubasDefaults) {
  const CheckerboardTexture board(nullptr, nullptr);
  EXPECT_EQ(board.eval(at(0.2f, 0.2f)), Spectrum(0.4f));
  EXPECT_EQ(board.eval(at(0.7f, 0.2f)), Spectrum(0.2f));
}

TEST(Checkerboard, TransformsUv) {
  const UvTransform to_uv(Transform::translate(0.5, 0, 0) * Transform::scale(10, 20, 1));
  const CheckerboardTexture board(grey(1), grey(0), to_uv);
  EXPECT_EQ(board.eval(at(0.02f, 0.01f)), Spectrum(0.0f));  // (0.7, 0.2)
  EXPECT_EQ(board.eval(at(0.07f, 0.01f)), Spectrum(1.0f));  // (1.2, 0.2)
}

TEST(Checkerboard, NestsTextures) {
  const auto inner =
      std::make_shared<CheckerboardTexture>(grey(0.3f), grey(0.6f), UvTransform(Transform::scale(2, 2, 1)));
  const CheckerboardTexture board(inner, grey(0));
  EXPECT_EQ(board.eval(at(0.1f, 0.1f)), Spectrum(0.3f));
  EXPECT_EQ(board.eval(at(0.3f, 0.1f)), Spectrum(0.6f));
  EXPECT_EQ(board.max(), 0.6f);
}

TEST(TextureValue, ShortensConstants) {
  EXPECT_TRUE(TextureValue(nullptr, 0.5f).is_constant());
  EXPECT_EQ(TextureValue(nullptr, 0.5f).eval(at(0, 0)), Spectrum(0.5f));
  EXPECT_TRUE(TextureValue(grey(1), 0.5f).is_one());
  EXPECT_EQ(TextureValue(grey(0.3f), 0.5f).eval_scalar(at(0, 0)), 0.3f);
  const TextureValue board(std::make_shared<CheckerboardTexture>(grey(1), grey(0)), 0.5f);
  EXPECT_FALSE(board.is_constant());
  EXPECT_EQ(board.eval(at(0.7f, 0.2f)), Spectrum(0.0f));
}

}  // namespace
}  // namespace turbid
