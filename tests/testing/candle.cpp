#include "testing/candle.h"

#include <fstream>
#include <map>
#include <vector>

#include "testing/peer_scenes.h"

namespace turbid::testing {
namespace {

/// The camera, the wax and the light of candle.obj.aux; what else there is is black.
constexpr const char* kHead = R"(<scene version="3.0.0">
  <default name="size" value="256"/><default name="max_depth" value="-1"/>
  <integrator type="volpath"><integer name="max_depth" value="$max_depth"/></integrator>
  <sensor type="perspective"><float name="fov" value="45"/><transform name="to_world">
    <lookat origin="-84.8188, 22.9605, 31.0322" target="-83.9528, 22.9605, 30.5322" up="0.5, 0, 0.8660"/></transform>
    <film type="hdrfilm"><integer name="width" value="$size"/><integer name="height" value="$size"/>
    <rfilter type="box"/></film></sensor>
)";
const std::string kWax = R"(<bsdf type="null"/><medium name="interior" type="homogeneous">
    <rgb name="sigma_s" value="2"/><rgb name="sigma_a" value="0"/></medium>)";
const std::string kWick = R"(<bsdf type="diffuse"><rgb name="reflectance" value="0.1294, 0.1020, 0.0745"/></bsdf>)";
const std::string kLight = R"(<bsdf type="null"/><emitter type="area"><rgb name="radiance" value="100"/></emitter>)";
const std::string kBlack = R"(<bsdf type="diffuse"><rgb name="reflectance" value="0"/></bsdf>)";

std::string content_of(const std::string& group) {
  if (group == "BTH_143") return kWax;
  if (group == "BTH_144") return kWick;
  return group == "Plane003" ? kLight : kBlack;
}

}  // namespace

std::filesystem::path candle_folder() { return peer_scenes().parent_path() / "smallupbp-candle"; }

std::string candle_absent() { return "no candle at " + candle_folder().string(); }

std::filesystem::path write_candle(const std::filesystem::path& folder) {
  std::ifstream file(candle_folder() / "candle.obj");
  std::string vertices, group;
  std::map<std::string, std::string> faces;
  for (std::string line; std::getline(file, line);) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.starts_with("v")) vertices += line + "\n";
    if (line.starts_with("g ")) group = line.substr(2);
    if (line.starts_with("f ")) faces[group] += line + "\n";
  }
  const std::filesystem::path scene = folder / "candle.xml";
  std::ofstream xml(scene);
  xml << kHead;
  for (const auto& [name, text] : faces) {
    std::ofstream(folder / (name + ".obj")) << vertices << text;
    xml << R"(  <shape type="obj"><string name="filename" value=")" << name << R"(.obj"/>)" << content_of(name)
        << "</shape>\n";
  }
  xml << "</scene>\n";
  return scene;
}

}  // namespace turbid::testing
