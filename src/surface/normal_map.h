#pragma once
#include "surface/tilted.h"
#include "texture/texture_value.h"

namespace turbid {

/// A material tilted by normals that a picture stores, as Mitsuba 3's `normalmap`: colour c means the normal 2 c - 1 in
/// the local shading frame, so (1/2, 1/2, 1) changes nothing.
class NormalMap final : public Tilted {
 public:
  /// null: no tilt.
  NormalMap(const TexturePtr& normals, BsdfPtr nested, const TiltSettings& settings = {})
      : Tilted(std::move(nested), settings), normals_(normals, 1.0f), plain_(!normals) {}

 private:
  Vec3 tilt(const SurfacePoint& point) const override {
    if (plain_) return {0, 0, 1};
    const Spectrum c = normals_.eval(point);
    return {2 * c[0] - 1, 2 * c[1] - 1, 2 * c[2] - 1};
  }

  TextureValue normals_;
  bool plain_;
};

}  // namespace turbid
