#pragma once
#include "core/rng.h"
#include "core/vector.h"

namespace turbid {

/// Which numbers a Sampler hands out.
enum class SamplerKind {
  kIndependent,  ///< uniform random numbers
  kSobol,        ///< padded 2D Sobol points with Owen scrambling, one scramble per pixel and dimension (Burley 2020)
};

/// What numbers of Sampler::aside are for: two users of one place and direction share none.
enum class Purpose : uint64_t {
  kAttenuation,         ///< random transmittance of a line through a medium that varies
  kAperture,            ///< the point of the aperture that a place is seen from
  kSplat,               ///< the pixel that a point of the film counts for
  kInsertedCollision,   ///< a collision between a vertex and the sensor
  kMarchedCollision,    ///< a collision on a ray that leaves a vertex, for the sensor
  kRefractedLight,      ///< light followed through a smooth mesh to a flight
  kIntegrationSpheres,  ///< null collisions on a flight of the sensor's walk
  kGatheredChord,       ///< where a light path's chord through a gathering volume is taken
  kLightsOfPlace,       ///< virtual lights chosen for a place, and places on ray lights
  kLightsOfWay,         ///< virtual lights chosen for a way of the sensor's walk, and places on both
  kCachedPlace,         ///< places on ray lights, seen from a cache point
  kCachedWay,           ///< places on ray lights and on a way that is a cache point
  kTableAtCollision,    ///< entering lights that a table is looked up for at a collision
  kTableAlongWay,       ///< the same along a way, and places on it
};

/// The source of the numbers u in [0, 1) that one sample of one pixel consumes, in order.
///
/// A sample is named by (seed, pixel, index); its numbers depend on nothing else, so any sample can be replayed alone
/// and the work can be split over threads and processes in any way.
class Sampler {
 public:
  Sampler(SamplerKind kind, uint64_t seed) : kind_(kind), seed_(seed) {}

  /// Begins sample `index` of pixel `pixel` (any number that names it uniquely).
  void start(uint64_t pixel, uint64_t index) {
    name_ = hash_counters(seed_, pixel, index);
    rng_ = Rng(name_);
    index_ = static_cast<uint32_t>(index);
    dimension_ = 0;
    if (kind_ == SamplerKind::kSobol) scramble_ = hash_counters(seed_, pixel);
  }

  /// Random numbers for questions beside the path: about the light that comes along a line, about the way to the sensor
  /// from a place. They depend on the sample, the purpose, the place and the direction alone, not on what was drawn
  /// before: so what is asked, or left out, changes nothing else. Whoever asks twice for one purpose, place and
  /// direction gets the same numbers.
  Rng aside(Purpose purpose, const Vec3& place, const Vec3& direction = Vec3(0)) const {
    const auto bits = [](float a, float b) {
      return uint64_t{std::bit_cast<uint32_t>(a)} << 32 | std::bit_cast<uint32_t>(b);
    };
    return Rng(hash_counters(name_ + static_cast<uint64_t>(purpose), bits(place.x, place.y), bits(place.z, direction.x),
                             bits(direction.y, direction.z)));
  }

  float next_1d() { return kind_ == SamplerKind::kIndependent ? rng_.next_float() : sobol_1d(); }

  Vec2 next_2d() {
    if (kind_ != SamplerKind::kIndependent) return sobol_2d();
    const float u = rng_.next_float();
    return {u, rng_.next_float()};
  }

 private:
  float sobol_1d();
  Vec2 sobol_2d();

  /// Dimensions past this one are random: stratification of deep path vertices is not worth its cost.
  static constexpr uint32_t kSobolDimensions = 64;

  SamplerKind kind_;
  uint64_t seed_;
  uint64_t name_ = 0;  ///< of the sample
  Rng rng_;
  uint64_t scramble_ = 0;
  uint32_t index_ = 0, dimension_ = 0;
};

}  // namespace turbid
