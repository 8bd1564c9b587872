#pragma once
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "geometry/mesh_data.h"

namespace turbid {

/// Meshes made by code, for scenes that ship without files. All have smooth vertex normals; all but make_grid are
/// closed, all but the icospheres and make_limbs have uvs. They stand around the y axis (up) unless said otherwise.
/// Wrong arguments throw std::invalid_argument.

/// A sphere of subdivided icosahedra: 20 * 4^subdivisions triangles of nearly equal size. subdivisions <= 10.
MeshData make_icosphere(float radius, int subdivisions);

/// A sphere of meridians and parallels.
MeshData make_uv_sphere(float radius, int segments, int rings);

/// A torus around the y axis.
MeshData make_torus(float major_radius, float minor_radius, int major_segments, int minor_segments);

/// A surface of revolution around the y axis. The profile is a list of (radius, height); traversed from bottom to top
/// its outside lies to the right, that is, away from the axis. It must begin and end on the axis (radius 0), or be a
/// ring: its last point equal to its first (counter-clockwise in the (radius, height) plane). Points repeated once make
/// a sharp edge.
MeshData make_lathe(std::span<const Vec2> profile, int segments);

/// A smooth curve through the points (Catmull-Rom), `steps` new points per span; a point given twice stays a corner.
std::vector<Vec2> smooth_profile(std::span<const Vec2> points, int steps);

/// A box of half sizes `half` with edges rounded by `radius`.
MeshData make_rounded_box(const Vec3& half, float radius, int segments);

/// An icosphere displaced by smooth noise: radius * (1 + amplitude * noise(frequency * direction)), noise in [-1, 1].
MeshData make_bumpy_sphere(float radius, float amplitude, float frequency, uint32_t seed, int subdivisions);

/// [-half.x, half.x] x [-half.y, half.y] in the xz plane, y = height(x, z), normals up.
MeshData make_grid(const Vec2& half, int nx, int nz, const std::function<float(float, float)>& height = {});

/// What lies below a grid, down to y = -depth: closed by walls and a floor.
MeshData make_slab(const Vec2& half, int nx, int nz, float depth, const std::function<float(float, float)>& height);

/// Trains of waves that travel about +x, as heights over the xz plane: water, ripples of sand, dunes.
struct WaveSettings {
  float length = 1;     ///< of the longest waves
  float amplitude = 0;  ///< no height is beyond it
  int trains = 8;       ///< from the longest to a quarter of it, all equally steep
  float spread = 40;    ///< largest angle between a train and the x axis, degrees
  float sharpness = 1;  ///< 1: sines; above: narrow crests, wide troughs
  float lean = 0;       ///< in [0, 1): how much steeper the side is that looks to +x
  float bend = 0;       ///< by how many lengths noise moves the crests
  uint32_t seed = 0;
};
class WaveField {
 public:
  explicit WaveField(const WaveSettings& settings);
  float operator()(float x, float z) const;

 private:
  struct Train {
    float x, z, phase, height;  ///< wave vector, 1/length
  };
  WaveSettings settings_;
  std::vector<Train> trains_;
};

/// A round cone: spheres along the line between its ends.
struct Limb {
  Vec3 from;
  float from_radius;
  Vec3 to;
  float to_radius;
};
/// Smooth noise that moves a surface outwards by up to `amplitude`.
struct Relief {
  float amplitude = 0, frequency = 1;
  uint32_t seed = 0;
};
/// A body of limbs that melt into each other over about the length `blend`, polygonised on cells of size `cell`;
/// details below that are lost. Where limbs overlap it bulges, by up to blend * ln(number of limbs).
MeshData make_limbs(std::span<const Limb> limbs, float blend, float cell, const Relief& relief = {});

/// A tube of varying radius around a polyline, closed by rounded ends; `radii` has one or as many entries as `points`.
MeshData make_tube(std::span<const Vec3> points, std::span<const float> radii, int segments);

/// Smooth noise in [-1, 1] on space, periodic in nothing, fixed by its seed; features are about one unit wide.
float smooth_noise(const Vec3& p, uint32_t seed);

/// The generators by name, with parameters by name, as scene files ask for them: <shape type="generated"> with a string
/// `kind` and floats. `points` is a flat list of numbers for the kinds that take a profile or a curve.
struct GeneratedShapeArguments {
  std::map<std::string, double> numbers;
  std::vector<double> points;
};
struct GeneratedShapeParameter {
  std::string name;
  double default_value;
  std::string meaning;
};
struct GeneratedShapeKind {
  std::string name;
  std::string meaning;
  std::vector<GeneratedShapeParameter> parameters;
  int point_size;                                                ///< numbers per point of `points`; 0: takes none
  std::function<MeshData(const GeneratedShapeArguments&)> make;  ///< every parameter is in `numbers`
};
const std::vector<GeneratedShapeKind>& generated_shape_kinds();
/// Makes a shape of the named kind; absent parameters take their defaults. Throws std::invalid_argument for unknown
/// kinds and parameters.
MeshData make_generated(const std::string& kind, GeneratedShapeArguments arguments);

}  // namespace turbid
