#pragma once
#include <algorithm>
#include <string>
#include <vector>

namespace turbid::testing {

/// Scenes that integrators are compared on, and the pieces that they are made of: a lamp over a floor, seen from the
/// side, with something in between. 16 x 16 pixels.
namespace pieces {

extern const std::string kFilm, kPinhole, kThinLens, kCropped, kFloor, kLamp, kMiddleLamp, kSmallLamp, kPoint, kSpot,
    kSky, kSun, kLaser;
/// A pinhole whose near plane clips collisions (not attenuation): without it their 1/distance^2 has no variance in
/// light tracing.
extern const std::string kPinholeInMedium;

std::string integer(const std::string& name, int value);
std::string medium(const std::string& role, const std::string& sigma_t, const std::string& albedo, float g = 0.4f);
std::string ball(const std::string& center, float radius, const std::string& content);
std::string fog(float radius = 2.5f, const std::string& sigma_t = "0.4, 0.4, 0.4");
/// A cloud in a box, heterogeneous, in a ball that passes light.
std::string smoke();
std::string glass(const std::string& center, float radius, const std::string& inside = "");
/// A coarse ball with smooth normals, in a file of this process: shading and geometric normals are far apart.
std::string octahedron(const std::string& placement, const std::string& bsdf);
/// The whole scene; `settings` of the integrator, volpath.
std::string scene(const std::string& content, const std::string& settings = "", const std::string& sensor = kPinhole);

}  // namespace pieces

struct SuiteScene {
  std::string name, xml;
  int block = 4;        ///< size of the blocks that are compared: larger where some integrator finds light rarely
  uint32_t effort = 1;  ///< how many times the samples of others
  /// Integrators whose estimator has no variance here (an unweighted 1/distance^2 in a medium): no z-test on them.
  std::vector<std::string> without_variance = {};

  bool has_variance(const std::string& integrator) const {
    return std::find(without_variance.begin(), without_variance.end(), integrator) == without_variance.end();
  }
};

/// What every pair of integrators is compared on.
std::vector<SuiteScene> suite();
/// The scene of that name.
const SuiteScene& suite_scene(const std::string& name);
/// A name as GoogleTest wants it.
std::string test_name(std::string name);

}  // namespace turbid::testing
