#pragma once
#include <array>
#include <cstddef>

#include "core/spectrum.h"

namespace turbid {

/// How the two walks of a path were put together.
enum class Technique {
  kJoin,        ///< by a line, or made by one walk alone
  kSurface,     ///< merged at a surface
  kPointPoint,  ///< merged at a collision (see Merging)
  kPointBeam,
  kBeamPoint,
  kBeamBeam,
};
/// As users name them.
inline constexpr std::array<const char*, 6> kTechniqueNames = {"bpt", "surf", "pp3d", "pb2d", "bp2d", "bb1d"};

/// A path from a light to the sensor that contributes: how it was put together, and what it carries.
struct Contribution {
  Spectrum value;           ///< as if this were the only way to make such paths
  float weight = 1;         ///< of multiple importance sampling
  int light_vertices = 0;   ///< made by the walk from the light, the light itself included
  int sensor_vertices = 0;  ///< made by the walk from the sensor, the sensor included
  int order = 0;            ///< collisions in media
  /// A vertex where both walks are merged counts as one of the sensor's.
  Technique technique = Technique::kJoin;

  int edges() const { return light_vertices + sensor_vertices - 1; }
};

/// Takes what paths bring.
class ContributionSink {
 public:
  virtual ~ContributionSink() = default;
  /// To the pixel whose sample is being made.
  virtual void gather(const Contribution& contribution) = 0;
  /// To any pixel of the crop window, given by its number.
  virtual void splat(size_t pixel, const Contribution& contribution) = 0;
};

}  // namespace turbid
