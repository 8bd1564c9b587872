// min_scattering and max_scattering are filters: the orders of one seed add up to its picture, in every integrator.
#include <gtest/gtest.h>

#include "integrator/rendering.h"
#include "integrator/suite.h"

namespace turbid::testing {
namespace {

using namespace pieces;

class Orders : public ::testing::TestWithParam<std::tuple<const char*, const char*>> {};

Film render(const std::string& xml, const std::string& integrator) {
  LoadedScene loaded = load_scene_from_string(xml, "test scene", {});
  std::vector<std::pair<std::string, std::string>> settings;
  if (integrator == "vpl" || integrator == "vrl")
    settings = {{"lights", "50"}, {"surface_caches", "20"}, {"volume_caches", "20"}};
  const auto replaced = replace_integrator(loaded.integrator, integrator, settings);
  const IntegratorSetup setup = make_integrator(replaced.description, loaded.document.get());
  return render_with(Scene(std::move(loaded.parts)), *setup.integrator, 16);
}

TEST_P(Orders, AddUpToTheFullImage) {
  const auto [integrator, place] = GetParam();
  constexpr int kDepth = 8;
  const std::string content = std::string(place) == "fog" ? kLamp + kFloor + fog()
                              : std::string(place) == "smoke"
                                  ? kLamp + kFloor + smoke()
                                  : kSmallLamp + kFloor + glass("0.5, 0.3, 1.6", 0.8f) + kSky + fog(1.2f);
  const auto render_orders = [&](const std::string& limits) {
    return render(scene(content, integer("max_depth", kDepth) + limits), integrator);
  };
  const Film full = render_orders("");
  Film sum(full.size());
  for (int order = 0; order < kDepth; ++order)
    sum.add(render_orders(integer("min_scattering", order) + integer("max_scattering", order)));
  // Splats are rounded to fixed point, whose steps a pilot of each render chooses.
  for (size_t i = 0; i < full.pixel_count(); ++i)
    for (int c = 0; c < kChannels; ++c)
      ASSERT_NEAR(sum.pixel(i).radiance[c], full.pixel(i).radiance[c], 1e-4 * (1 + full.pixel(i).radiance[c]))
          << "pixel " << i;
}

INSTANTIATE_TEST_SUITE_P(Everywhere, Orders,
                         ::testing::Combine(::testing::Values("volpath", "ptracer", "bdpt", "vpl", "vrl"),
                                            ::testing::Values("fog", "smoke", "glass")),
                         [](const auto& instance) {
                           return std::string(std::get<0>(instance.param)) + "_" + std::get<1>(instance.param);
                         });

}  // namespace
}  // namespace turbid::testing
