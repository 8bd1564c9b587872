#include <fmt/format.h>

#include <cmath>

#include "geometry/generated.h"
#include "geometry/row_mesh.h"

namespace turbid {
namespace {
float real(const GeneratedShapeArguments& a, const char* name) { return static_cast<float>(a.numbers.at(name)); }

int whole(const GeneratedShapeArguments& a, const char* name) {
  const double value = a.numbers.at(name);
  require(value == std::floor(value) && std::abs(value) < 1e9, fmt::format("'{}' must be a whole number", name));
  return static_cast<int>(value);
}

uint32_t seed(const GeneratedShapeArguments& a) {
  const int value = whole(a, "seed");
  require(value >= 0, "'seed' must not be negative");
  return static_cast<uint32_t>(value);
}

MeshData lathe(const GeneratedShapeArguments& a) {
  std::vector<Vec2> profile;
  for (size_t i = 0; i + 1 < a.points.size(); i += 2)
    profile.push_back({static_cast<float>(a.points[i]), static_cast<float>(a.points[i + 1])});
  const int steps = whole(a, "smooth");
  if (steps > 0) profile = smooth_profile(profile, steps);
  return make_lathe(profile, whole(a, "segments"));
}

MeshData tube(const GeneratedShapeArguments& a) {
  std::vector<Vec3> points;
  for (size_t i = 0; i + 2 < a.points.size(); i += 3)
    points.push_back(
        {static_cast<float>(a.points[i]), static_cast<float>(a.points[i + 1]), static_cast<float>(a.points[i + 2])});
  const float radius = real(a, "radius");
  return make_tube(points, {&radius, 1}, whole(a, "segments"));
}

MeshData limbs(const GeneratedShapeArguments& a) {
  const auto n = [&](size_t i) { return static_cast<float>(a.points[i]); };
  std::vector<Limb> limbs;
  for (size_t i = 0; i + 7 < a.points.size(); i += 8)
    limbs.push_back({{n(i), n(i + 1), n(i + 2)}, n(i + 3), {n(i + 4), n(i + 5), n(i + 6)}, n(i + 7)});
  return make_limbs(limbs, real(a, "blend"), real(a, "cell"), {real(a, "amplitude"), real(a, "frequency"), seed(a)});
}

MeshData height_field(const GeneratedShapeArguments& a, const std::function<float(float, float)>& height) {
  const Vec2 half(real(a, "half_x"), real(a, "half_z"));
  const int nx = whole(a, "cells_x"), nz = whole(a, "cells_z");
  const float depth = real(a, "depth");
  return depth == 0 ? make_grid(half, nx, nz, height) : make_slab(half, nx, nz, depth, height);
}

MeshData grid(const GeneratedShapeArguments& a) {
  const float amplitude = real(a, "amplitude"), frequency = real(a, "frequency");
  const uint32_t s = seed(a);
  return height_field(a, [=](float x, float z) { return amplitude * smooth_noise(Vec3(x, 0, z) * frequency, s); });
}

MeshData waves(const GeneratedShapeArguments& a) {
  return height_field(a, WaveField({.length = real(a, "length"),
                                    .amplitude = real(a, "amplitude"),
                                    .trains = whole(a, "trains"),
                                    .spread = real(a, "spread"),
                                    .sharpness = real(a, "sharpness"),
                                    .lean = real(a, "lean"),
                                    .bend = real(a, "bend"),
                                    .seed = seed(a)}));
}
}  // namespace

const std::vector<GeneratedShapeKind>& generated_shape_kinds() {
  static const std::vector<GeneratedShapeKind> kinds{
      {"icosphere",
       "sphere of nearly equal triangles",
       {{"radius", 1, "radius"}, {"subdivisions", 4, "20 * 4^subdivisions triangles"}},
       0,
       [](const auto& a) { return make_icosphere(real(a, "radius"), whole(a, "subdivisions")); }},
      {"uv_sphere",
       "sphere of meridians and parallels around y",
       {{"radius", 1, "radius"}, {"segments", 64, "meridians"}, {"rings", 32, "parallels"}},
       0,
       [](const auto& a) { return make_uv_sphere(real(a, "radius"), whole(a, "segments"), whole(a, "rings")); }},
      {"torus",
       "torus around y",
       {{"major_radius", 1, "radius of the circle that is thickened"},
        {"minor_radius", 0.3, "radius of the tube"},
        {"segments", 96, "around the axis"},
        {"minor_segments", 48, "around the tube"}},
       0,
       [](const auto& a) {
         return make_torus(real(a, "major_radius"), real(a, "minor_radius"), whole(a, "segments"),
                           whole(a, "minor_segments"));
       }},
      {"lathe",
       "surface of revolution around y of the profile `points` (radius, height), from bottom to top",
       {{"segments", 96, "around the axis"},
        {"smooth", 0, "points that a smooth curve puts between two of the profile"}},
       2,
       lathe},
      {"rounded_box",
       "box with rounded edges",
       {{"half_x", 1, "half size along x"},
        {"half_y", 1, "half size along y"},
        {"half_z", 1, "half size along z"},
        {"radius", 0.1, "of the edges"},
        {"segments", 8, "across 45 degrees of an edge"}},
       0,
       [](const auto& a) {
         return make_rounded_box({real(a, "half_x"), real(a, "half_y"), real(a, "half_z")}, real(a, "radius"),
                                 whole(a, "segments"));
       }},
      {"bumpy_sphere",
       "sphere displaced by smooth noise",
       {{"radius", 1, "mean radius"},
        {"amplitude", 0.1, "largest displacement, as a fraction of the radius"},
        {"frequency", 3, "bumps per radius"},
        {"seed", 0, "names the noise"},
        {"subdivisions", 6, "20 * 4^subdivisions triangles"}},
       0,
       [](const auto& a) {
         return make_bumpy_sphere(real(a, "radius"), real(a, "amplitude"), real(a, "frequency"), seed(a),
                                  whole(a, "subdivisions"));
       }},
      {"grid",
       "plane around the origin, normal +y, displaced by smooth noise",
       {{"half_x", 1, "half size along x"},
        {"half_z", 1, "half size along z"},
        {"cells_x", 1, "cells along x"},
        {"cells_z", 1, "cells along z"},
        {"amplitude", 0, "largest height"},
        {"frequency", 1, "bumps per unit"},
        {"seed", 0, "names the noise"},
        {"depth", 0, "closed below by walls and a floor at y = -depth; 0: a sheet"}},
       0,
       grid},
      {"waves",
       "plane around the origin, normal +y, displaced by trains of waves: water, ripples, dunes",
       {{"half_x", 1, "half size along x"},
        {"half_z", 1, "half size along z"},
        {"cells_x", 128, "cells along x"},
        {"cells_z", 128, "cells along z"},
        {"amplitude", 0.05, "largest height"},
        {"length", 1, "of the longest waves"},
        {"trains", 8, "number of trains of waves"},
        {"spread", 40, "largest angle between a train and the x axis, degrees"},
        {"sharpness", 1, "1: sines; above: narrow crests"},
        {"lean", 0, "in [0, 1): how much steeper the side towards +x is"},
        {"bend", 0, "by how many lengths noise moves the crests"},
        {"seed", 0, "names the waves"},
        {"depth", 0, "closed below by walls and a floor at y = -depth; 0: a sheet"}},
       0,
       waves},
      {"limbs",
       "round cones, `points` (x, y, z, radius, x, y, z, radius) each, melted into one body",
       {{"blend", 0.05, "length over which limbs melt into each other"},
        {"cell", 0.02, "of the lattice of triangles"},
        {"amplitude", 0, "largest displacement by noise"},
        {"frequency", 1, "bumps per unit"},
        {"seed", 0, "names the noise"}},
       8,
       limbs},
      {"tube",
       "round tube along the curve `points` (x, y, z), with rounded ends",
       {{"radius", 0.1, "radius"}, {"segments", 24, "around the curve"}},
       3,
       tube},
  };
  return kinds;
}

MeshData make_generated(const std::string& kind, GeneratedShapeArguments arguments) {
  std::string known;
  for (const GeneratedShapeKind& k : generated_shape_kinds()) {
    known += (known.empty() ? "" : ", ") + k.name;
    if (k.name != kind) continue;
    for (const auto& [name, value] : arguments.numbers) {
      bool is_known = false;
      for (const GeneratedShapeParameter& p : k.parameters) is_known |= p.name == name;
      require(is_known, fmt::format("generated shape '{}' has no parameter '{}'", kind, name));
    }
    for (const GeneratedShapeParameter& p : k.parameters) arguments.numbers.try_emplace(p.name, p.default_value);
    const size_t size = static_cast<size_t>(k.point_size);
    if (size == 0)
      require(arguments.points.empty(), fmt::format("generated shape '{}' takes no points", kind));
    else
      require(
          arguments.points.size() % size == 0,
          fmt::format("the points of '{}' have {} numbers each, found {} in all", kind, size, arguments.points.size()));
    return k.make(arguments);
  }
  throw std::invalid_argument(fmt::format("there is no generated shape '{}'; known are {}", kind, known));
}

}  // namespace turbid
