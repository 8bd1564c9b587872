#pragma once
#include <array>

#include "core/spectrum.h"
#include "medium/phase_function.h"
#include "table/light_field.h"
#include "table/quadtree.h"

namespace turbid {

/// How light is simulated in mode `seed` (S1 sect. 3.3.1, 4.1).
struct QuadtreeSettings {
  uint64_t seed = 1;
  size_t photons = 500'000;
  int from_order = 3;  ///< collisions from which on light counts, the first and the last one included
};

/// Length of the segments that light sets out along, mean free paths (S1 sect. 3.3.1).
inline constexpr float kUnitSegment = 2;

/// The directions that lobes are computed in: cells of half a sphere about the line from the source, the sagittal plane
/// its edge; 5 degrees from that line, 10 about it.
class LobeDirections {
 public:
  static constexpr int kPolar = 36, kAzimuths = 18;
  static constexpr size_t kCount = size_t{kPolar} * kAzimuths;

  LobeDirections();
  /// The middle of each, in the frame of SagittalView.
  alignas(64) std::array<float, kCount> x, y, z;
  /// Solid angle that each stands for, both halves of the sphere together.
  std::array<float, kCount> solid_angle;

  /// Between the middles, bilinear; `values` holds kCount numbers.
  static float interpolate(const float* values, const Vec3& direction);
};

/// Light around one kind of source as photons left it, before lobes are compressed: "4D table". Infinite medium, mean
/// free path 1, the albedo of each channel inside.
struct PhotonLobes {
  Quadtree tree;
  /// [leaf][channel][direction]: source radiance at a leaf's middle, 1/sr per cubic mean free path.
  std::vector<float> values;
  /// [leaf][channel]: what the interpolant is multiplied by within a leaf, so that it puts into the leaf what photons
  /// did: between middles light falls off steeply and bends upwards, where interpolation adds to it.
  std::vector<float> factors;

  const float* lobe(size_t leaf, size_t channel) const {
    return values.data() + (leaf * kChannels + channel) * LobeDirections::kCount;
  }
};

/// How far tables reach: 32 mean free paths, 64 for phase functions with a mean cosine above 0.75 (S1 sect. 4.1).
float reach_of(double mean_cosine);

/// Simulates light from a collision and light that sets out along a unit segment, unscattered, by the same photons:
/// each collision is one of the first kind, and of the second when its photon began somewhere on the segment. A pilot
/// of 300,000 collisions cuts the cells. Photons go on by chance, with the largest channel's albedo, late ones more
/// seldom (SeedPhotons). Late collisions are put in seldom and count more, as they tell little that their neighbours do
/// not. Light that arrives is sorted into steps of 1.25 degrees (ArrivalLobes). Depends on the seed alone, not on the
/// number of threads. Throws std::invalid_argument, with advice, for albedos above kLargestAlbedo.
std::array<PhotonLobes, kSourceKinds> simulate_photons(const PhaseFunction& phase, const Spectrum& albedo,
                                                       const QuadtreeSettings& settings,
                                                       const Quadtree::Limits& limits = {});

}  // namespace turbid
