// From a scene file to what a Scene is assembled from.
#include <fstream>

#include "medium/henyey_greenstein.h"
#include "medium/homogeneous.h"
#include "medium/materials.h"
#include "reading.h"
#include "scene/builder.h"
#include "scene/catalog.h"
#include "testing/peer_scenes.h"
#include "testing/temporary_folder.h"

namespace turbid::testing {
namespace {

LoadedScene load(const std::string& content, const Overrides& overrides = {}) {
  return load_scene_from_string(scene_of(content), "test.xml", overrides);
}

/// The medium inside the first shape.
const Medium& first_medium(const LoadedScene& scene) { return *scene.parts.objects.at(0).interior; }

LoadedScene load_medium(const std::string& parameters, const std::string& scene_unit = "") {
  return load("<integrator type=\"moment\"><integrator type=\"volpath\">" +
              (scene_unit.empty() ? "" : "<string name=\"scene_unit\" value=\"" + scene_unit + "\"/>") +
              "</integrator></integrator><shape type=\"cube\"><bsdf type=\"null\"/><medium name=\"interior\" "
              "type=\"homogeneous\">" +
              parameters + "</medium></shape>");
}

void expect_near(const Spectrum& value, const Spectrum& expected) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(value[c], expected[c], 1e-5f * std::abs(expected[c])) << "channel " << c;
}

TEST(Loader, ReadsOutlierRejectionOfTheFilm) {
  const auto film_with = [](const std::string& values) {
    return load("<sensor type=\"perspective\"><film type=\"hdrfilm\">" + values + "</film></sensor>").parts.film;
  };
  EXPECT_FALSE(film_with("<string name=\"outlier_rejection\" value=\"none\"/>").outliers);
  const FilmSettings plain = film_with("<string name=\"outlier_rejection\" value=\"reweight\"/>");
  EXPECT_EQ(plain.outliers->start, 1);
  EXPECT_EQ(plain.outliers->base, 8);
  EXPECT_EQ(plain.outliers->kappa, 1);
  const FilmSettings own = film_with(
      "<string name=\"outlier_rejection\" value=\"reweight\"/><float name=\"outlier_start\" value=\"0.5\"/>"
      "<float name=\"outlier_base\" value=\"4\"/><float name=\"outlier_kappa\" value=\"2\"/>");
  EXPECT_EQ(own.outliers->start, 0.5);
  EXPECT_EQ(own.outliers->base, 4);
  EXPECT_EQ(own.outliers->kappa, 2);
}

TEST(Loader, ReadsAWholeScene) {
  const LoadedScene scene = load(
      "<default name=\"spp\" value=\"8\"/><integrator type=\"volpath\"><integer name=\"max_depth\" value=\"7\"/>"
      "</integrator>"
      "<sensor type=\"perspective\"><float name=\"fov\" value=\"40\"/>"
      "<film type=\"hdrfilm\"><integer name=\"width\" value=\"64\"/><integer name=\"height\" value=\"32\"/>"
      "<integer name=\"crop_width\" value=\"10\"/><integer name=\"crop_offset_y\" value=\"4\"/>"
      "<string name=\"pixel_format\" value=\"rgba\"/><rfilter type=\"box\"/></film>"
      "<sampler type=\"multijitter\"><integer name=\"sample_count\" value=\"$spp\"/></sampler></sensor>"
      "<bsdf type=\"diffuse\" id=\"white\"/>"
      "<shape type=\"cube\" id=\"box\"><ref id=\"white\"/></shape>"
      "<shape type=\"sphere\"><ref id=\"white\"/><emitter type=\"area\"/></shape>"
      "<emitter type=\"constant\"/>",
      {{"spp", "32"}});
  ASSERT_EQ(scene.parts.objects.size(), 2u);
  EXPECT_EQ(scene.parts.objects[0].id, "box");
  EXPECT_EQ(scene.parts.objects[0].bsdf, scene.parts.objects[1].bsdf);  // made once
  EXPECT_FALSE(scene.parts.objects[0].bounds_media);
  EXPECT_FALSE(scene.parts.objects[0].emitter);
  EXPECT_TRUE(scene.parts.objects[1].emitter);
  EXPECT_EQ(scene.parts.emitters.size(), 1u);
  EXPECT_EQ(scene.parts.film.size, Vec2i(64, 32));
  EXPECT_EQ(scene.parts.film.crop_offset, Vec2i(0, 4));
  EXPECT_EQ(scene.parts.film.crop_size, Vec2i(10, 28));
  EXPECT_TRUE(scene.parts.film.alpha);
  EXPECT_FALSE(scene.parts.film.outliers);
  EXPECT_EQ(scene.parts.sampler, SamplerKind::kSobol);
  EXPECT_EQ(scene.parts.sample_count, 32u);
  EXPECT_TRUE(scene.integrator.declared);
  EXPECT_EQ(scene.integrator.node->type, "volpath");
}

TEST(Loader, FillsInWhatMitsubaFillsIn) {
  const LoadedScene scene = load("<shape type=\"cube\"/><shape type=\"cube\"><emitter type=\"area\"/></shape>");
  EXPECT_EQ(scene.parts.objects[0].bsdf->albedo({}), Spectrum(0.5f));
  EXPECT_EQ(scene.parts.objects[1].bsdf->albedo({}), Spectrum(0.0f));  // what shines is black
  EXPECT_FALSE(scene.integrator.declared);
  EXPECT_EQ(scene.integrator.node->type, "path");
  EXPECT_EQ(scene.parts.film.size, Vec2i(768, 576));
  EXPECT_EQ(scene.parts.sample_count, 4u);
  // The default camera looks along +z at [-1, 1]^3 from outside.
  const Vec3 eye = scene.parts.sensor->position();
  EXPECT_NEAR(eye.x, 0, 1e-6f);
  EXPECT_NEAR(eye.z, -1 - 1 / std::tan(22.5f * kPi / 180), 1e-5f);
}

TEST(Loader, MediaByExtinctionAndAlbedo) {
  const LoadedScene scene = load_medium(
      "<float name=\"scale\" value=\"2\"/><rgb name=\"sigma_t\" value=\"1 2 4\"/>"
      "<rgb name=\"albedo\" value=\"0.5 0.25 1\"/><phase type=\"hg\"><float name=\"g\" value=\"-0.3\"/></phase>");
  EXPECT_TRUE(scene.parts.objects[0].bounds_media);
  expect_near(first_medium(scene).sigma_t(), {2, 4, 8});
  expect_near(first_medium(scene).sigma_s(), {1, 1, 8});
  EXPECT_EQ(first_medium(scene).phase().mean_cosine(), -0.3f);
}

TEST(Loader, EqualExtinctionStaysEqualWhateverTheAlbedo) {
  const LoadedScene scene = load_medium(
      "<float name=\"scale\" value=\"3\"/><float name=\"sigma_t\" value=\"1.7\"/>"
      "<rgb name=\"albedo\" value=\"0.99 0.51 0.3\"/>");
  EXPECT_TRUE(dynamic_cast<const HomogeneousMedium&>(first_medium(scene)).is_grey());
}

TEST(Loader, MediaByScatteringAndAbsorption) {
  const LoadedScene scene =
      load_medium("<rgb name=\"sigma_s\" value=\"1 2 3\"/><spectrum name=\"sigma_a\" value=\"0.5\"/>");
  expect_near(first_medium(scene).sigma_t(), {1.5f, 2.5f, 3.5f});
  expect_near(first_medium(scene).sigma_s(), {1, 2, 3});
  EXPECT_EQ(first_medium(scene).phase().mean_cosine(), 0);
}

TEST(Loader, UnitsOfMediaFollowTheSceneUnit) {
  const std::string per_cm = "<float name=\"sigma_t\" value=\"3\"/><string name=\"unit\" value=\"cm^-1\"/>";
  expect_near(first_medium(load_medium(per_cm, "mm")).sigma_t(), Spectrum(0.3f));
  expect_near(first_medium(load_medium(per_cm, "cm")).sigma_t(), Spectrum(3.0f));
  expect_near(first_medium(load_medium(per_cm, "m")).sigma_t(), Spectrum(300.0f));
  expect_near(first_medium(load_medium(per_cm, "0.05")).sigma_t(), Spectrum(15.0f));
  expect_near(first_medium(load_medium(per_cm)).sigma_t(), Spectrum(3.0f));  // nobody says how long a unit is
  const std::string per_unit = "<float name=\"sigma_t\" value=\"3\"/>";
  expect_near(first_medium(load_medium(per_unit, "mm")).sigma_t(), Spectrum(3.0f));
}

TEST(Loader, ReducedScatteringIsDividedByOneMinusG) {
  const LoadedScene scene = load_medium(
      "<float name=\"sigma_s\" value=\"2\"/><float name=\"sigma_a\" value=\"1\"/><boolean name=\"reduced\" "
      "value=\"true\"/><phase type=\"hg\"><float name=\"g\" value=\"0.75\"/></phase>");
  expect_near(first_medium(scene).sigma_s(), Spectrum(8.0f));
  expect_near(first_medium(scene).sigma_t(), Spectrum(9.0f));
}

TEST(Loader, MediaThatAreDescribedAlikeAreOne) {
  const auto fog = [](const std::string& name, const std::string& g) {
    return "<medium name=\"" + name +
           "\" type=\"homogeneous\"><rgb name=\"sigma_t\" value=\"1, 2, 3\"/><phase type=\"hg\">" +
           "<float name=\"g\" value=\"" + g + "\"/></phase></medium>";
  };
  const auto shape = [](const std::string& media) {
    return "<shape type=\"cube\"><bsdf type=\"null\"/>" + media + "</shape>";
  };
  const LoadedScene scene =
      load(shape(fog("interior", "0.5")) + shape(fog("interior", "0.6") + fog("exterior", "0.5")));
  const auto& objects = scene.parts.objects;
  EXPECT_EQ(objects.at(0).interior, objects.at(1).exterior);
  EXPECT_NE(objects.at(0).interior, objects.at(1).interior);
}

TEST(Loader, MeasuredMaterials) {
  const Material& wax = *find_material("S1 Wax");
  const LoadedScene scene = load_medium("<string name=\"material\" value=\"S1 Wax\"/>", "cm");
  expect_near(first_medium(scene).sigma_s(), wax.sigma_s * 10);
  expect_near(first_medium(scene).sigma_t(), (wax.sigma_s + wax.sigma_a) * 10);
  EXPECT_NEAR(first_medium(scene).phase().mean_cosine(), wax.g.mean(), 1e-6f);
  // Jensen's are reduced: with a phase function that scatters forward they scatter more often.
  const Material& ketchup = *find_material("Ketchup");
  const LoadedScene forward = load_medium(
      "<string name=\"material\" value=\"Ketchup\"/><phase type=\"hg\"><float name=\"g\" value=\"0.5\"/></phase>",
      "mm");
  expect_near(first_medium(forward).sigma_s(), ketchup.sigma_s * 2);
}

TEST(Loader, TheSensorMayDeclareItsMedium) {
  const LoadedScene scene = load(
      "<medium type=\"homogeneous\" id=\"fog\"/><sensor type=\"thinlens\"><float name=\"aperture_radius\" "
      "value=\"0.1\"/><ref id=\"fog\"/></sensor><shape type=\"cube\"><ref name=\"exterior\" id=\"fog\"/></shape>");
  EXPECT_TRUE(scene.parts.sensor_medium_declared);
  EXPECT_EQ(scene.parts.sensor_medium, scene.parts.objects[0].exterior);
  EXPECT_FALSE(scene.parts.objects[0].interior);
}

TEST(Loader, NamesEveryFileThatItRead) {
  const TemporaryFolder folder;
  std::ofstream(folder.file("a.obj")) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  std::ofstream(folder.file("part.xml"))
      << "<scene version=\"3.0.0\"><shape type=\"obj\"><string name=\"filename\" value=\"a.obj\"/></shape></scene>";
  std::ofstream(folder.file("main.xml")) << scene_of(
      "<include filename=\"part.xml\"/><shape type=\"obj\"><string name=\"filename\" value=\"a.obj\"/></shape>");
  const LoadedScene scene = load_scene(folder.file("main.xml"));
  EXPECT_EQ(scene.parts.objects.size(), 2u);
  const std::vector<std::filesystem::path> expected = {folder.file("main.xml"), folder.file("part.xml"),
                                                       folder.file("a.obj")};
  EXPECT_EQ(scene.files, expected);
}

TEST(Loader, APictureIsLoadedOnceForEachWayOfReadingIt) {
  const TemporaryFolder folder;
  std::ofstream(folder.file("a.hdr"), std::ios::binary) << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n"
                                                        << std::string("\x80\x80\x80\x81", 4);
  const std::string picture = "<string name=\"filename\" value=\"a.hdr\"/>";
  std::ofstream(folder.file("main.xml")) << scene_of(
      "<texture type=\"bitmap\" id=\"a\">" + picture + "</texture><texture type=\"bitmap\" id=\"b\">" + picture +
      "</texture><texture type=\"bitmap\" id=\"c\">" + picture + "<boolean name=\"raw\" value=\"true\"/></texture>");
  const SceneDocument document = read_document(folder.file("main.xml"));
  Builder builder(document, 0);
  const auto& nodes = document.root->children;
  EXPECT_EQ(builder.texture(*nodes[0].node), builder.texture(*nodes[1].node));
  EXPECT_NE(builder.texture(*nodes[0].node), builder.texture(*nodes[2].node));
  EXPECT_NEAR(builder.texture(*nodes[0].node)->mean()[1], 1, 0.01f);
}

/// Every default in the tables can be read as its parameter's type and lies in its range.
TEST(Catalog, DefaultsAreValidValues) {
  for (const CategoryDescription& category : plugin_catalog()) {
    for (const PluginDescription& plugin : category.plugins) {
      SCOPED_TRACE(category.title + " " + plugin.name);
      EXPECT_FALSE(plugin.summary.empty());
      SceneNode node;
      node.category = category.category;
      node.type = plugin.name;
      std::vector<Parameter> optional;
      for (const Parameter& parameter : plugin.parameters) {
        EXPECT_FALSE(parameter.meaning.empty()) << parameter.name;
        const std::string& text = parameter.default_text;
        if (text == kRequired || text == kOptional || parameter.type == ParameterType::kFile) continue;
        optional.push_back(parameter);
        node.values.push_back({parameter.name, UntypedText{text}, {}});
      }
      EXPECT_EQ(complaint([&] { Properties(node, optional); }), "");
    }
  }
}

/// Mitsuba's own test scenes, where they are at hand.
TEST(Loader, ReadsThePeersScenes) {
  const std::filesystem::path folder = peer_scenes();
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << peer_scenes_absent();
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with("test_") || entry.path().extension() != ".xml") continue;
    const std::string text = complaint([&] { load_scene(entry.path()); });
    EXPECT_EQ(text, "") << name;
  }
}

}  // namespace
}  // namespace turbid::testing
