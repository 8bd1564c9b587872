#pragma once
#include <memory>

#include "texture/texture.h"

namespace turbid {

/// The same value everywhere.
class ConstantTexture final : public Texture {
 public:
  explicit ConstantTexture(const Spectrum& value) : value_(value) {}
  explicit ConstantTexture(float value) : value_(value) {}
  Spectrum eval(const SurfacePoint&) const override { return value_; }
  /// Grey values come back unrounded (the luminance weights sum to 1 only up to rounding).
  float eval_scalar(const SurfacePoint&) const override {
    return value_.min() == value_.max() ? value_[0] : value_.luminance();
  }
  Spectrum mean() const override { return value_; }
  bool is_constant() const override { return true; }
  float max() const override { return value_.max(); }

 private:
  Spectrum value_;
};

}  // namespace turbid
