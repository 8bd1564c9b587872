#pragma once
#include "integrator/agreement.h"
#include "integrator/suite.h"

namespace turbid::testing {

/// What scenes with light behind smooth meshes are made of, and the comparison of their light.
namespace pieces {

/// Glass of index 1.4.
extern const std::string kGlass;
/// A thin medium that scatters forward, on the inside.
std::string clear();
/// The same with an extinction that differs from place to place and from channel to channel.
std::string uneven();
/// A medium "fog" that fills a large ball: one medium on both sides of whatever refers to it, as collisions on one side
/// of a boundary are looked up by their medium.
std::string fog_around();
/// A shining ball.
std::string lamp(const std::string& center, float radius, const std::string& radiance = "30, 40, 50");
/// Bodies of size 0.9 above the floor, of triangles: `content` is their BSDF and media.
std::string sphere(const std::string& content);
std::string bumpy(const std::string& content);
std::string slab(const std::string& content);
/// In the bodies, `near_clip` at which the sensor begins to see.
std::string camera_inside(float near_clip = 0.01f);

}  // namespace pieces

/// A scene with one of its integrators, whose passes are rendered one by one.
class Rendering {
 public:
  Rendering(const std::string& xml, const std::string& integrator,
            const std::vector<std::pair<std::string, std::string>>& settings);
  Film pass(uint64_t seed, uint32_t index, uint32_t samples);
  Counters counters() const { return setup_.integrator->counters(); }

 private:
  LoadedScene loaded_;
  IntegratorSetup setup_;
  Scene scene_;
};

/// Of one picture over another: the ratio of all light, and the z-test of the blocks.
struct Verdict {
  double ratio, error;
  std::array<double, 2> errors;  ///< of either, relative
  ZTestResult blocks;

  /// At the house's significance for so many comparisons like this one.
  bool accepted(double comparisons) const;
};
Verdict compare_light(const PassStatistics& reference, const PassStatistics& other);

}  // namespace turbid::testing
