// The candle of Křivánek et al. 2014: wax with an index-matched boundary, lit by an area light.
#include "testing/candle.h"

#include <gtest/gtest.h>

#include "integrator/rendering.h"
#include "testing/temporary_folder.h"

namespace turbid::testing {
namespace {

class Candle : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(candle_folder() / "candle.obj")) GTEST_SKIP() << candle_absent();
    file_ = write_candle(folder_.path());
  }

  /// The mean over the picture of each pass.
  ImageMean render(const std::string& integrator, const std::vector<std::pair<std::string, std::string>>& settings,
                   int depth, uint32_t samples, int size) const {
    LoadedScene loaded = load_scene(file_, {{"size", std::to_string(size)}, {"max_depth", std::to_string(depth)}});
    const auto replaced = replace_integrator(loaded.integrator, integrator, settings);
    const IntegratorSetup setup = make_integrator(replaced.description, loaded.document.get());
    return mean_of(render_with(Scene(std::move(loaded.parts)), *setup.integrator, samples));
  }

  TemporaryFolder folder_;
  std::filesystem::path file_;
};

/// Light comes through the boundary by next-event estimation. Splats and photons correlate the pixels: the errors of
/// `upbp` are taken twice.
TEST_F(Candle, IsThatOfVolpath) {
  for (const int depth : {4, 60}) {
    const ImageMean reference = render("volpath", {}, depth, 96, 48);
    for (const char* techniques : {"auto", "bpt+surf+pp3d+pb2d+bb1d"}) {
      const ImageMean mean = render("upbp", {{"techniques", techniques}}, depth, 32, 48);
      EXPECT_LT(z_score(mean.grey(), 2 * mean.grey_error(), reference.grey(), reference.grey_error()), 4)
          << depth << " " << techniques << ": " << mean.grey() << " +- " << mean.grey_error() << ", volpath "
          << reference.grey() << " +- " << reference.grey_error();
      EXPECT_LT(mean.grey_error(), 0.02 * mean.grey());
    }
  }
}

}  // namespace
}  // namespace turbid::testing
