#pragma once
#include <string>

#include "texture/texture.h"

namespace turbid {

/// Numbers that a mesh carries, on its vertices (interpolated) or faces, times a scale: as Mitsuba 3's
/// `mesh_attribute`. One texture serves any number of meshes: the point knows its own. 0 where there is no mesh or it
/// has no such attribute (the reader of scenes refuses that).
class MeshAttributeTexture final : public Texture {
 public:
  /// The name begins with "vertex_" or "face_", else std::invalid_argument.
  explicit MeshAttributeTexture(std::string name, float scale = 1);

  Spectrum eval(const SurfacePoint& point) const override;
  /// A single channel as it is, the luminance of three.
  float eval_scalar(const SurfacePoint& point) const override;
  /// Nothing is known without a mesh: half of the scale stands for it, as if the numbers filled [0, 1].
  Spectrum mean() const override { return Spectrum(0.5f * scale_); }
  float max() const override { return scale_; }

  const std::string& name() const { return name_; }

 private:
  std::string name_;
  float scale_;
};

}  // namespace turbid
