#include "integrator/suite.h"

#include <fstream>

#include "testing/temporary_folder.h"

namespace turbid::testing {
namespace pieces {

const std::string kFilm = R"(<film type="hdrfilm"><integer name="width" value="16"/><integer name="height" value="16"/>
  <rfilter type="box"/></film>)";
namespace {
const std::string kView =
    R"(<float name="fov" value="45"/><transform name="to_world"><lookat origin="0, -6, 2" target="0, 0, 0.5"
  up="0, 0, 1"/></transform>)";
}
const std::string kPinhole = R"(<sensor type="perspective">)" + kView + kFilm + "</sensor>";
const std::string kPinholeInMedium =
    R"(<sensor type="perspective"><float name="near_clip" value="2"/>)" + kView + kFilm + "</sensor>";
const std::string kThinLens =
    R"(<sensor type="thinlens"><float name="aperture_radius" value="0.4"/><float name="focus_distance" value="4"/>)" +
    kView + kFilm + "</sensor>";
const std::string kCropped = R"(<sensor type="perspective"><float name="fov" value="45"/>
  <transform name="to_world"><lookat origin="0, -6, 2" target="0, 0, 0.5" up="0, 0, 1"/></transform>
  <film type="hdrfilm"><integer name="width" value="32"/><integer name="height" value="24"/>
  <integer name="crop_offset_x" value="10"/><integer name="crop_offset_y" value="4"/>
  <integer name="crop_width" value="16"/><integer name="crop_height" value="16"/>
  <rfilter type="gaussian"/></film></sensor>)";
const std::string kFloor = R"(<shape type="rectangle"><transform name="to_world"><scale value="3"/></transform>
  <bsdf type="diffuse"><rgb name="reflectance" value="0.7, 0.5, 0.3"/></bsdf></shape>)";
const std::string kLamp = R"(<shape type="sphere"><point name="center" value="0.5, 0.3, 2"/>
  <float name="radius" value="0.4"/><emitter type="area"><rgb name="radiance" value="3, 4, 5"/></emitter></shape>)";
const std::string kSmallLamp = R"(<shape type="sphere"><point name="center" value="0.5, 0.3, 2"/>
  <float name="radius" value="0.08"/><emitter type="area"><rgb name="radiance" value="80, 100, 120"/></emitter></shape>)";
const std::string kMiddleLamp = R"(<shape type="sphere"><point name="center" value="0.5, 0.3, 2"/>
  <float name="radius" value="0.2"/><emitter type="area"><rgb name="radiance" value="12, 16, 20"/></emitter></shape>)";
const std::string kPoint = R"(<emitter type="point"><point name="position" value="0.5, 0.3, 1.5"/>
  <rgb name="intensity" value="5, 4, 3"/></emitter>)";
const std::string kSpot = R"(<emitter type="spot"><rgb name="intensity" value="9, 8, 7"/>
  <float name="cutoff_angle" value="30"/><transform name="to_world">
  <lookat origin="1, 0, 3" target="0, 0, 0" up="0, 1, 0"/></transform></emitter>)";
const std::string kSky = R"(<emitter type="constant"><rgb name="radiance" value="0.5, 0.7, 1"/></emitter>)";
const std::string kSun = R"(<emitter type="directional"><vector name="direction" value="0.3, 0.5, -1"/>
  <rgb name="irradiance" value="2, 1.8, 1.5"/></emitter>)";
const std::string kLaser = R"(<emitter type="collimated"><rgb name="power" value="3, 2, 4"/>
  <float name="radius" value="0.2"/><transform name="to_world">
  <lookat origin="-2, 0, 2" target="0.4, 0.2, 0" up="0, 1, 0"/></transform></emitter>)";

std::string integer(const std::string& name, int value) {
  return "<integer name=\"" + name + "\" value=\"" + std::to_string(value) + "\"/>";
}

std::string medium(const std::string& role, const std::string& sigma_t, const std::string& albedo, float g) {
  return "<medium name=\"" + role + "\" type=\"homogeneous\"><rgb name=\"sigma_t\" value=\"" + sigma_t +
         "\"/><rgb name=\"albedo\" value=\"" + albedo + "\"/><phase type=\"hg\"><float name=\"g\" value=\"" +
         std::to_string(g) + "\"/></phase></medium>";
}

std::string ball(const std::string& center, float radius, const std::string& content) {
  return "<shape type=\"sphere\"><point name=\"center\" value=\"" + center + "\"/><float name=\"radius\" value=\"" +
         std::to_string(radius) + "\"/>" + content + "</shape>";
}

std::string fog(float radius, const std::string& sigma_t) {
  return ball("0, 0, 0.5", radius, R"(<bsdf type="null"/>)" + medium("interior", sigma_t, "0.9, 0.8, 0.7"));
}

std::string smoke() {
  return ball("0, 0, 0.5", 2.2f, R"(<bsdf type="null"/><medium name="interior" type="heterogeneous">
    <volume name="sigma_t" type="constvolume"><rgb name="value" value="0.3, 0.6, 0.9"/>
    <transform name="to_world"><scale value="2.5"/><translate x="-1.2" y="-1.2" z="-0.5"/></transform></volume>
    <volume name="albedo" type="constvolume"><rgb name="value" value="0.9, 0.8, 0.7"/></volume></medium>)");
}

std::string glass(const std::string& center, float radius, const std::string& inside) {
  return ball(center, radius,
              R"(<bsdf type="dielectric"><float name="int_ior" value="1.4"/>
    <float name="ext_ior" value="1"/></bsdf>)" +
                  inside);
}

std::string octahedron(const std::string& placement, const std::string& bsdf) {
  static const TemporaryFolder folder;
  const std::string file = folder.file("octahedron.ply");
  std::ofstream(file) << "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\n"
                         "property float z\nproperty float nx\nproperty float ny\nproperty float nz\n"
                         "element face 8\nproperty list uchar int vertex_indices\nend_header\n"
                         "1 0 0 1 0 0\n-1 0 0 -1 0 0\n0 1 0 0 1 0\n0 -1 0 0 -1 0\n0 0 1 0 0 1\n0 0 -1 0 0 -1\n"
                         "3 0 2 4\n3 2 1 4\n3 1 3 4\n3 3 0 4\n3 2 0 5\n3 1 2 5\n3 3 1 5\n3 0 3 5\n";
  return "<shape type=\"ply\"><string name=\"filename\" value=\"" + file + "\"/><transform name=\"to_world\">" +
         placement + "</transform>" + bsdf + "</shape>";
}

std::string scene(const std::string& content, const std::string& settings, const std::string& sensor) {
  return "<scene version=\"3.0.0\"><integrator type=\"volpath\">" + settings + "</integrator>" + sensor + content +
         "</scene>";
}

}  // namespace pieces

std::vector<SuiteScene> suite() {
  using namespace pieces;
  const std::string max5 = integer("max_depth", 5), max6 = integer("max_depth", 6), max4 = integer("max_depth", 4);
  const std::string solid = R"(<rotate z="1" angle="20"/><translate x="-0.4" y="-1" z="1"/>)";
  const std::string lens = R"(<scale value="0.5"/><rotate z="1" angle="20"/><translate x="0.3" y="0.2" z="1.05"/>)";
  const std::string rough = R"(<bsdf type="roughdielectric"><float name="alpha" value="0.4"/>
    <float name="int_ior" value="1.4"/><float name="ext_ior" value="1"/></bsdf>)";
  const std::string murk = medium("interior", "1.5, 1, 0.7", "0.95, 0.9, 0.8");
  const std::string around =
      ball("0, 0, 0", 9, R"(<bsdf type="null"/>)" + medium("interior", "0.1, 0.15, 0.2", "0.9, 0.9, 0.9"));
  const std::string in_endless = kPinholeInMedium.substr(0, kPinholeInMedium.find("</sensor>")) +
                                 medium("medium", "0.03, 0.05, 0.08", "0.9, 0.9, 0.9") + "</sensor>";
  return {
      {"surfaces", scene(kLamp + kFloor, max5)},
      {"lamp in fog, any length", scene(kLamp + kFloor + fog(), integer("rr_depth", 2))},
      {"point in fog", scene(kPoint + kFloor + fog(), max5), 4, 1, {"volpath"}},
      {"small lamp in fog", scene(kSmallLamp + kFloor + fog(), max5)},
      {"spot in fog", scene(kSpot + kFloor + fog(1.5f), max5)},
      {"sky on fog", scene(kSky + kFloor + fog(1.5f), max5)},
      {"sun on fog", scene(kSun + kFloor + fog(1.5f), max5)},
      {"laser in fog", scene(kLaser + kFloor + fog(1.9f), max5)},
      {"chromatic medium", scene(kLamp + fog(2.2f, "0.1, 0.6, 2.5"), max5)},
      {"heterogeneous medium", scene(kLamp + kFloor + smoke(), max5)},
      {"rough glass", scene(kLamp + kFloor + ball("0.2, -0.8, 1", 0.9f, rough), max4)},
      {"rough glass with murk", scene(kLamp + kFloor + ball("0.2, -0.8, 1", 0.9f, rough + murk), max6), 8, 2},
      {"smooth glass with murk", scene(kLamp + kFloor + glass("0.2, -0.8, 1", 0.9f, murk), max6), 8, 2},
      {"index-matched glass with murk",
       scene(kLamp + kFloor + ball("0.2, -0.8, 1", 0.9f, R"(<bsdf type="dielectric"><float name="int_ior" value="1"/>
             <float name="ext_ior" value="1"/></bsdf>)" + murk),
             max6)},
      {"caustic into fog", scene(kMiddleLamp + kFloor + glass("0.4, 0.2, 1.2", 0.4f) + fog(), max6), 8, 4},
      {"point light behind glass with fog",
       scene(kPoint + kFloor + glass("0.4, 0.2, 0.9", 0.4f) + fog(), max6),
       4,
       1,
       {"volpath"}},
      {"lamp inside glass with murk", scene(kMiddleLamp + kFloor + glass("0.5, 0.3, 1.6", 0.8f, murk), max6), 8, 4},
      {"coarse mesh, smooth normals", scene(kLamp + kFloor + octahedron(solid, R"(<bsdf type="diffuse"/>)"), max5)},
      {"coarse mesh, rough metal",
       scene(kLamp + kFloor +
                 octahedron(solid, R"(<bsdf type="roughconductor"><float name="alpha" value="0.4"/></bsdf>)"),
             max5)},
      {"coarse glass, smooth normals",
       scene(kLamp + kFloor + octahedron(lens, R"(<bsdf type="dielectric"><float name="int_ior" value="1.4"/></bsdf>)"),
             max6)},
      {"thin lens", scene(kLamp + kFloor + fog(), max5, kThinLens), 8, 2},
      {"sensor inside the medium", scene(kLamp + kFloor + around, max5, kPinholeInMedium)},
      {"endless medium", scene(kLamp + kFloor, max4, in_endless)},
      {"endless medium under a sky", scene(kSky + kFloor, integer("max_depth", 3), in_endless)},
      {"priorities and a world medium",
       scene(kLamp + kFloor + fog(1.5f) + medium("world", "0.05, 0.05, 0.05", "0.9, 0.9, 0.9"), max4,
             kPinholeInMedium)},
      {"several media in turn",
       scene(kLamp + kFloor + fog() +
                 ball("-0.6, -0.5, 1", 0.7f,
                      R"(<bsdf type="null"/>)" + medium("interior", "2, 1, 0.5", "0.9, 0.9, 0.9", 0.7f) +
                          medium("exterior", "0.4, 0.4, 0.4", "0.9, 0.8, 0.7")),
             max6)},
  };
}

const SuiteScene& suite_scene(const std::string& name) {
  static const std::vector<SuiteScene> scenes = suite();
  return *std::find_if(scenes.begin(), scenes.end(), [&](const SuiteScene& scene) { return scene.name == name; });
}

std::string test_name(std::string name) {
  for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  return name;
}

}  // namespace turbid::testing
