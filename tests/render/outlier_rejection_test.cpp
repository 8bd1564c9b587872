// The film's outlier rejection in whole renders: cascades are summed by every kind of integrator, in any number of
// threads, across interruptions, and change nothing else.
#include "image/outlier_rejection.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "core/error.h"
#include "core/log.h"
#include "image/film_image.h"
#include "image/image_file.h"
#include "integrator/integrators.h"
#include "render/checkpoint.h"
#include "render/render_job.h"
#include "render/threads.h"
#include "testing/temporary_folder.h"
#include "toy_task.h"

namespace turbid {
namespace {

using testing::same_bits;

const OutlierSettings kLow{.start = 0.03125};

/// A lamp above a floor, seen in a mirror ball too: bounces to the lamp by way of the ball are rare and bright.
const std::string kScene = R"(<scene version="3.0.0">
  <default name="rejection" value="none"/>
  <integrator type="$integrator"><integer name="max_depth" value="6"/></integrator>
  <sensor type="perspective"><float name="fov" value="50"/>
    <transform name="to_world"><lookat origin="0, 3, 6" target="0, 0.5, 0" up="0, 1, 0"/></transform>
    <film type="hdrfilm"><integer name="width" value="20"/><integer name="height" value="16"/>
      <string name="outlier_rejection" value="$rejection"/><float name="outlier_start" value="0.03125"/>
      <rfilter type="box"/></film></sensor>
  <shape type="rectangle"><transform name="to_world"><rotate x="1" angle="-90"/><scale value="4"/></transform></shape>
  <shape type="sphere"><point name="center" value="0, 0.7, 0"/><float name="radius" value="0.7"/>
    <bsdf type="conductor"/></shape>
  <shape type="sphere"><point name="center" value="1.5, 2, 0.5"/><float name="radius" value="0.1"/>
    <emitter type="area"><rgb name="radiance" value="150, 100, 60"/></emitter></shape>
  <shape type="sphere"><point name="center" value="-1.2, 0.6, 0.8"/><float name="radius" value="0.5"/>
    <bsdf type="null"/>
    <medium name="interior" type="homogeneous"><float name="sigma_t" value="2"/><float name="albedo" value="0.8"/>
    </medium></shape>
</scene>)";

class OutlierRender : public ::testing::TestWithParam<const char*> {
 protected:
  OutlierRender() { set_log_level(LogLevel::kQuiet); }
  ~OutlierRender() override { set_log_level(LogLevel::kNotices); }

  /// Renders with files when `path` is not empty.
  static RenderResult render_scene(const std::string& rejection, uint64_t samples, const std::string& path = "") {
    LoadedScene loaded =
        load_scene_from_string(kScene, "test scene", {{"integrator", GetParam()}, {"rejection", rejection}});
    const IntegratorSetup setup = make_integrator(loaded.integrator, loaded.document.get());
    const Scene scene(std::move(loaded.parts));
    RenderOptions options;
    options.budget.samples = samples;
    options.quiet = true;
    options.resume = true;
    options.output.path = path;
    options.output.outliers = scene.film().outliers;
    return render(make_task(scene, *setup.integrator), options);
  }
};

bool same_pixels(const Film& a, const Film& b) {
  return std::memcmp(a.pixels().data(), b.pixels().data(), a.pixels().size_bytes()) == 0;
}

TEST_P(OutlierRender, SumsThePictureInCascadesAndLeavesItAsItIs) {
  const Film off = render_scene("none", 16).film, on = render_scene("reweight", 16).film;
  EXPECT_TRUE(off.layer_names().empty());
  EXPECT_TRUE(same_pixels(off, on));
  const Cascades cascades = Cascades::in(on, kLow).value();
  double bright = 0;
  for (size_t i = 0; i < on.pixel_count(); ++i)
    for (size_t c = 0; c < kChannels; ++c) {
      double sum = 0;
      for (size_t j = 0; j < Cascades::kCount; ++j) sum += on.layers(i)[cascades.channel(j) + c];
      EXPECT_NEAR(sum, on.pixel(i).radiance[c], 2e-6 * sum) << i;
      bright += sum - on.layers(i)[cascades.channel(0) + c] - on.layers(i)[cascades.channel(1) + c];
    }
  EXPECT_GT(bright, 1) << "nothing here could be an outlier";
}

TEST_P(OutlierRender, SameBitsWithAnyNumberOfThreads) {
  const auto film_with = [](int threads) {
    return with_threads(threads, [] { return render_scene("reweight", 16).film; });
  };
  const Film one = film_with(1);
  EXPECT_TRUE(same_bits(one, film_with(2)));
  EXPECT_TRUE(same_bits(one, film_with(5)));
}

TEST_P(OutlierRender, ResumesToTheSameBitsAndWritesBothPictures) {
  const testing::TemporaryFolder folder;
  const std::string path = folder.file("a.exr");
  render_scene("reweight", 64, path);
  EXPECT_EQ(read_checkpoint(folder.file("a.ckpt")).film.layer_names(), Cascades::layer_names());
  const RenderResult resumed = render_scene("reweight", 144, path);
  EXPECT_EQ(resumed.statistics.passes, 2u);  // 1 of 3 was there
  EXPECT_TRUE(same_bits(resumed.film, render_scene("reweight", 144).film));

  const Image image = read_image(path), mean = film_to_image(resumed.film, false);
  EXPECT_EQ(image.channel_count(), 6u);
  const Image expected = reject_outliers(mean, resumed.film, kLow);
  for (const char* name : {"R", "G", "B", "unweighted.R", "unweighted.G", "unweighted.B"})
    EXPECT_TRUE(std::ranges::equal(image.channel(name), expected.channel(name))) << name;
  EXPECT_TRUE(std::ranges::equal(image.channel("unweighted.G"), mean.channel("G")));
  EXPECT_FALSE(std::ranges::equal(image.channel("G"), mean.channel("G")));
  EXPECT_TRUE(image.metadata.at("outlier_rejection").starts_with("reweight start=0.03125 base=8 kappa=1: takes 0."));
}

INSTANTIATE_TEST_SUITE_P(Integrators, OutlierRender, ::testing::Values("volpath", "ptracer", "bdpt"));

/// An integrator with a layer of a name of its choice.
struct Named final : Integrator {
  std::string name;
  explicit Named(std::string n) : name(std::move(n)) {}
  bool render_pass(const Scene&, const Pass&, Film&, const StopFlag&) override { return true; }
  std::vector<std::string> layer_names() const override { return {name}; }
};

TEST(OutlierLayers, ComeAfterThoseOfTheIntegratorAndRefuseANameThatIsTaken) {
  LoadedScene loaded =
      load_scene_from_string(kScene, "test scene", {{"integrator", "path"}, {"rejection", "reweight"}});
  const Scene scene(std::move(loaded.parts));
  std::vector<std::string> expected = Cascades::layer_names();
  expected.insert(expected.begin(), "albedo.R");
  EXPECT_EQ(film_layers(scene, Named("albedo.R")), expected);
  EXPECT_THROW(film_layers(scene, Named("unweighted.R")), SceneError);
}

}  // namespace
}  // namespace turbid
