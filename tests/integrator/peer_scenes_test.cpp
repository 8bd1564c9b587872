// Mitsuba 3's own render tests, judged as Mitsuba judges itself (NUMERICS 10): 2e6 samples per image, a z-test per
// pixel in CIE XYZ against its reference and the variance of one sample.
#include "testing/peer_scenes.h"

#include <gtest/gtest.h>

#include "image/film_image.h"
#include "image/image_file.h"
#include "image/z_test.h"
#include "integrator/rendering.h"

namespace turbid::testing {
namespace {

ZTestResult judge(const Film& film, const std::filesystem::path& reference) {
  const Image image = film_to_image(film, false), mean = read_image(reference.string() + "_ref_rgb.exr"),
              variance = read_image(reference.string() + "_ref_rgb_var.exr");
  const auto xyz = [](const Image& of) { return to_xyz(color_channels(of, "image")); };
  return z_test(xyz(image), film.samples(), xyz(mean), xyz(variance));
}

class PeerScene : public ::testing::TestWithParam<std::pair<const char*, const char*>> {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(peer_scenes())) GTEST_SKIP() << peer_scenes_absent();
  }
};

TEST_P(PeerScene, PassesTheZTest) {
  const auto [name, integrator] = GetParam();
  const std::filesystem::path scenes = peer_scenes() / "tests/scenes";
  const std::filesystem::path file = scenes / (std::string(name) + "_" + integrator + ".xml");
  LoadedScene loaded = load_scene(file);
  const IntegratorSetup setup = make_integrator(loaded.integrator, loaded.document.get());
  const Scene scene(std::move(loaded.parts));
  const auto samples = static_cast<uint32_t>(2'000'000 / (scene.film().size.x * scene.film().size.y));
  const Film film = render_with(scene, *setup.integrator, samples);
  const ZTestResult result = judge(
      film, file.parent_path() / "refs" / file.filename().string().substr(0, file.filename().string().rfind('_')));
  EXPECT_TRUE(result.accepted()) << 100 * result.pass_fraction() << " % of the tests pass, worst |z| " << result.worst_z
                                 << " at pixel " << result.worst_index;
}

INSTANTIATE_TEST_SUITE_P(Mitsuba, PeerScene,
                         ::testing::Values(std::pair("participating_media/test_homo_null_envmap", "volpath"),
                                           std::pair("participating_media/test_homo_dielectric_envmap", "volpath"),
                                           std::pair("participating_media/test_homo_area_light", "volpath"),
                                           std::pair("participating_media/test_homo_spectral_sigmat", "volpathmis"),
                                           std::pair("participating_media/test_surf_area_light", "volpath"),
                                           std::pair("participating_media/test_hetero_sigmat", "volpath"),
                                           std::pair("bsdf_spheres/test_pointlight", "path"),
                                           std::pair("bsdf_spheres/test_envmap", "path"),
                                           std::pair("bsdf_spheres/test_textured_diffuse", "path"),
                                           std::pair("bsdf_spheres/test_roughdielectric", "path"),
                                           std::pair("floating_sphere/test_directional", "direct"),
                                           std::pair("various_emitters/test_various_emitters", "ptracer")),
                         [](const auto& instance) {
                           const std::string name = instance.param.first;
                           return name.substr(name.find("test_") + 5);
                         });

// The harness must reject the image of a scene whose light is 3 % too bright.
TEST_F(PeerScene, HarnessNoticesAPlantedError) {
  const std::filesystem::path file = peer_scenes() / "tests/scenes/floating_sphere/test_directional_direct.xml";
  LoadedScene loaded = load_scene(file);
  const IntegratorSetup setup = make_integrator(loaded.integrator, loaded.document.get());
  const Scene scene(std::move(loaded.parts));
  Film film = render_with(scene, *setup.integrator, 868);
  for (size_t i = 0; i < film.pixel_count(); ++i)
    for (double& value : film.pixel(i).radiance) value *= 1.03;
  EXPECT_FALSE(judge(film, file.parent_path() / "refs/test_directional").accepted());
}

}  // namespace
}  // namespace turbid::testing
