#include "texture/strokes.h"

#include <gtest/gtest.h>

#include "texture/constant.h"

namespace turbid::testing {
namespace {

TexturePtr grey(float value) { return std::make_shared<ConstantTexture>(Spectrum(value)); }

SurfacePoint at(float u, float v) {
  SurfacePoint point;
  point.uv = {u, v};
  return point;
}

TEST(Strokes, CoverHalfTheirWidthOnEachSide) {
  const StrokesTexture line({{{0.2f, 0.5f}, {0.8f, 0.5f}}}, 0.1f, grey(0.9f), grey(0.1f));
  EXPECT_EQ(line.eval(at(0.5f, 0.54f)), Spectrum(0.9f));
  EXPECT_EQ(line.eval(at(0.5f, 0.56f)), Spectrum(0.1f));
  EXPECT_EQ(line.eval_scalar(at(0.84f, 0.5f)), 0.9f) << "round ends";
  EXPECT_EQ(line.eval_scalar(at(0.86f, 0.5f)), 0.1f);
  const float covered = 0.6f * 0.1f + kPi * sqr(0.05f);
  EXPECT_NEAR(line.mean()[0], 0.1f + 0.8f * covered, 0.005f);
  EXPECT_EQ(line.max(), 0.9f);
}

TEST(Strokes, APointIsADot) {
  const StrokesTexture dot({{{0.5f, 0.5f}, {0.5f, 0.5f}}}, 0.2f, nullptr, nullptr);
  EXPECT_EQ(dot.eval_scalar(at(0.59f, 0.5f)), 0.4f);
  EXPECT_EQ(dot.eval_scalar(at(0.61f, 0.5f)), 0.2f);
}

}  // namespace
}  // namespace turbid::testing
