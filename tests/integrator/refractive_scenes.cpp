#include "integrator/refractive_scenes.h"

#include <fstream>
#include <numbers>

#include "testing/temporary_folder.h"

namespace turbid::testing {
namespace pieces {
namespace {

std::string generated(const std::string& kind, const std::string& numbers, const std::string& content,
                      const std::string& placement = "<translate z=\"0.9\"/>") {
  return "<shape type=\"generated\"><string name=\"kind\" value=\"" + kind + "\"/>" + numbers +
         "<transform name=\"to_world\">" + placement + "</transform>" + content + "</shape>";
}

std::string number(const std::string& name, const std::string& value) {
  return "<float name=\"" + name + "\" value=\"" + value + "\"/>";
}

/// A grid of 6 x 6 x 6 cells of three channels, in a file of this process.
std::string grid_file() {
  static const TemporaryFolder folder;
  const std::string name = folder.file("uneven.vol");
  std::ofstream file(name, std::ios::binary);
  constexpr int kSide = 6;
  const int32_t header[] = {1, kSide, kSide, kSide, kChannels};
  const float box[] = {0, 0, 0, 1, 1, 1};
  file.write("VOL\3", 4);
  file.write(reinterpret_cast<const char*>(header), sizeof(header));
  file.write(reinterpret_cast<const char*>(box), sizeof(box));
  Rng rng(4);
  for (int i = 0; i < kSide * kSide * kSide * kChannels; ++i) {
    const float value = 0.2f + 1.6f * rng.next_float() * rng.next_float();
    file.write(reinterpret_cast<const char*>(&value), sizeof(value));
  }
  return name;
}

}  // namespace

const std::string kGlass = R"(<bsdf type="dielectric"><float name="int_ior" value="1.4"/>
  <float name="ext_ior" value="1"/></bsdf>)";

std::string clear() { return medium("interior", "0.5, 0.7, 0.9", "0.9, 0.8, 0.7", 0.3f); }

std::string uneven() {
  return R"(<medium name="interior" type="heterogeneous"><volume name="sigma_t" type="gridvolume">
    <string name="filename" value=")" +
         grid_file() + R"("/><transform name="to_world"><translate x="-0.5" y="-0.5" z="-0.5"/><scale value="2.4"/>
    <translate z="0.9"/></transform></volume><volume name="albedo" type="constvolume"><rgb name="value"
    value="0.9, 0.8, 0.7"/></volume><phase type="hg"><float name="g" value="0.3"/></phase></medium>)";
}

std::string fog_around() {
  return R"(<medium type="homogeneous" id="fog"><rgb name="sigma_t" value="0.1, 0.12, 0.15"/>
    <rgb name="albedo" value="0.9, 0.9, 0.9"/><phase type="hg"><float name="g" value="0.3"/></phase></medium>)" +
         ball("0, 0, 0", 9, R"(<bsdf type="null"/><ref name="interior" id="fog"/>)");
}

std::string lamp(const std::string& center, float radius, const std::string& radiance) {
  return ball(center, radius, "<emitter type=\"area\"><rgb name=\"radiance\" value=\"" + radiance + "\"/></emitter>");
}

std::string sphere(const std::string& content) {
  return generated("icosphere", number("radius", "0.9") + number("subdivisions", "3"), content);
}

std::string bumpy(const std::string& content) {
  return generated(
      "bumpy_sphere",
      number("radius", "0.9") + number("amplitude", "0.15") + number("frequency", "3") + number("subdivisions", "3"),
      content);
}

std::string slab(const std::string& content) {
  return "<shape type=\"cube\"><transform name=\"to_world\"><scale x=\"1.2\" y=\"0.8\" z=\"0.5\"/>"
         "<translate z=\"0.7\"/></transform>" +
         content + "</shape>";
}

std::string camera_inside(float near_clip) {
  return R"(<sensor type="perspective"><float name="fov" value="70"/>)" +
         number("near_clip", std::to_string(near_clip)) +
         R"(<transform name="to_world"><lookat origin="0.1, -0.5, 0.8" target="0, 1, 0.9" up="0, 0, 1"/></transform>)" +
         kFilm + "</sensor>";
}

}  // namespace pieces

Rendering::Rendering(const std::string& xml, const std::string& integrator,
                     const std::vector<std::pair<std::string, std::string>>& settings)
    : loaded_(load_scene_from_string(xml, "test scene", {})),
      setup_(make_integrator(replace_integrator(loaded_.integrator, integrator, settings).description,
                             loaded_.document.get())),
      scene_(std::move(loaded_.parts)) {
  setup_.integrator->prepare(scene_, 1, StopFlag());
}

Film Rendering::pass(uint64_t seed, uint32_t index, uint32_t samples) {
  Film film(scene_.film().image_size(), setup_.integrator->layer_names());
  setup_.integrator->render_pass(scene_, {seed, uint64_t{index} * samples, samples}, film, StopFlag());
  return film;
}

bool Verdict::accepted(double comparisons) const {
  const double tests = comparisons * static_cast<double>(blocks.tests + 1);
  const double p = std::erfc(std::abs(ratio - 1) / error / std::numbers::sqrt2);
  return std::min(p, blocks.smallest_p) > ZTestResult::kSignificance / tests;
}

Verdict compare_light(const PassStatistics& reference, const PassStatistics& other) {
  double sum[2] = {}, variance[2] = {};
  for (size_t block = 0; block < reference.block_count(); ++block)
    for (int i = 0; i < 2; ++i) {
      const PassStatistics& s = i == 0 ? reference : other;
      double deviation = 0;
      for (int c = 0; c < kChannels; ++c) {
        sum[i] += s.mean(block, c);
        deviation += std::sqrt(s.variance(block, c));
      }
      variance[i] += sqr(deviation) / kPasses;
    }
  const double ratio = sum[1] / sum[0];
  const std::array errors = {std::sqrt(variance[0]) / sum[0], std::sqrt(variance[1]) / sum[1]};
  return {ratio, ratio * std::hypot(errors[0], errors[1]), errors,
          two_estimator_z_test(reference, other, std::vector<bool>(reference.block_count()))};
}

}  // namespace turbid::testing
