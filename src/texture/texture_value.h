#pragma once
#include <memory>

#include "texture/texture.h"

namespace turbid {

using TexturePtr = std::shared_ptr<const Texture>;

/// A parameter that a texture gives, with a short way for textures that are the same everywhere: no virtual call.
class TextureValue {
 public:
  explicit TextureValue(float constant) : constant_(constant), scalar_(constant) {}
  /// `fallback` stands in for a missing texture (null pointer).
  TextureValue(const TexturePtr& texture, float fallback) : TextureValue(fallback) {
    if (texture && texture->is_constant()) {
      constant_ = texture->mean();
      scalar_ = texture->eval_scalar(SurfacePoint{});
    } else {
      varying_ = texture;
    }
  }

  Spectrum eval(const SurfacePoint& point) const { return varying_ ? varying_->eval(point) : constant_; }
  float eval_scalar(const SurfacePoint& point) const { return varying_ ? varying_->eval_scalar(point) : scalar_; }
  Spectrum mean() const { return varying_ ? varying_->mean() : constant_; }
  bool is_constant() const { return !varying_; }
  /// True when it is 1 everywhere.
  bool is_one() const { return !varying_ && constant_ == Spectrum(1.0f); }

 private:
  TexturePtr varying_;
  Spectrum constant_;
  float scalar_;
};

}  // namespace turbid
