// Layers beside the picture.
#include "integrator/aov.h"

#include <gtest/gtest.h>

#include "integrator/rendering.h"

namespace turbid::testing {
namespace {

std::string scene_with(const std::string& integrator, const std::string& content) {
  return R"(<scene version="3.0.0">)" + integrator + R"(
    <sensor type="perspective"><float name="fov" value="20"/>
      <transform name="to_world"><lookat origin="0,0,5" target="0,0,0" up="0,1,0"/></transform>
      <film type="hdrfilm"><integer name="width" value="5"/><integer name="height" value="5"/><rfilter type="box"/></film>
    </sensor><emitter type="constant"><rgb name="radiance" value="1"/></emitter>)" +
         content + "</scene>";
}
std::string aov(const std::string& aovs, const std::string& inner = "<integrator type=\"volpath\"/>") {
  return "<integrator type=\"aov\"><string name=\"aovs\" value=\"" + aovs + "\"/>" + inner + "</integrator>";
}

constexpr size_t kMiddle = 12;  ///< pixel

/// The mean of a channel in a pixel.
double layer(const Film& film, const std::string& name, size_t pixel = kMiddle) {
  for (size_t c = 0; c < film.layer_names().size(); ++c)
    if (film.layer_names()[c] == name) return film.layers(pixel)[c] / static_cast<double>(film.samples());
  throw std::runtime_error("no layer " + name);
}

const std::string kWall = R"(<shape type="rectangle"><transform name="to_world"><scale value="9"/>
  <translate z="-2"/></transform><bsdf type="diffuse"><rgb name="reflectance" value="0.2, 0.4, 0.6"/></bsdf></shape>)";
const std::string kGlassPane = R"(<shape type="sphere"><bsdf type="dielectric"><float name="int_ior" value="1.5"/>
  <float name="ext_ior" value="1"/></bsdf></shape>)";

TEST(Aov, NamesAreMitsubas) {
  const Film film =
      render_text(scene_with(aov("a:albedo, d:depth,p:position u:uv,g:geo_normal,s:sh_normal,i:prim_index"), kWall), 1);
  EXPECT_EQ(film.layer_names(), (std::vector<std::string>{"a.R", "a.G", "a.B", "d.T", "p.X", "p.Y", "p.Z", "u.U", "u.V",
                                                          "g.X", "g.Y", "g.Z", "s.X", "s.Y", "s.Z", "i.I"}));
}

TEST(Aov, SeesAWall) {
  const Film film =
      render_text(scene_with(aov("a:albedo,d:depth,p:position,n:sh_normal,u:uv,s:shape_index"), kWall + kWall), 64);
  EXPECT_NEAR(layer(film, "a.R"), 0.2, 1e-6);
  EXPECT_NEAR(layer(film, "a.B"), 0.6, 1e-6);
  EXPECT_NEAR(layer(film, "d.T"), 7, 0.02);
  EXPECT_NEAR(layer(film, "p.Z"), -2, 1e-5);
  EXPECT_NEAR(layer(film, "n.Z"), 1, 1e-5);
  EXPECT_NEAR(layer(film, "u.U"), 0.5, 0.01);
}

TEST(Aov, LooksThroughSmoothGlass) {
  const Film film = render_text(scene_with(aov("a:albedo,d:depth,n:sh_normal"), kWall + kGlassPane), 4096);
  // Through the middle of the ball: what is not reflected, 4 % at each of two surfaces (and again inside), comes
  // from the wall, the rest from the empty sky, or goes round inside: (1 - R)^2 / (1 - R^2) = 0.923.
  EXPECT_NEAR(layer(film, "a.G"), 0.4 * 0.923, 0.4 * 0.02);
  EXPECT_GT(layer(film, "d.T"), 6);
  EXPECT_NEAR(layer(film, "n.Z"), 0.923, 0.02);
}

TEST(Aov, AlbedoOfAMediumIsThatOfItsFirstScattering) {
  const std::string ball = R"(<shape type="sphere"><bsdf type="null"/><medium name="interior" type="homogeneous">
    <float name="sigma_t" value="0.7"/><rgb name="albedo" value="0.9, 0.5, 0.1"/></medium></shape>)";
  const uint32_t samples = 20000;
  const Film film = render_text(scene_with(aov("a:albedo,d:depth,n:sh_normal"), ball + kWall), samples);
  // Seen along a diameter: 1 - T scatters in the ball, the rest sees the wall. Other rays of the pixel are nearly
  // diameters.
  const double passed = std::exp(-0.7 * 2 * 0.995);
  EXPECT_NEAR(layer(film, "a.R"), (1 - passed) * 0.9 + passed * 0.2, 0.01);
  EXPECT_NEAR(layer(film, "a.B"), (1 - passed) * 0.1 + passed * 0.6, 0.01);
  EXPECT_NEAR(layer(film, "n.Z"), passed, 0.02);  // no normal in the medium
  // With `path` there is no medium.
  const Film surfaces = render_text(scene_with(aov("a:albedo", "<integrator type=\"path\"/>"), ball + kWall), 64);
  EXPECT_NEAR(layer(surfaces, "a.R"), 0.2, 1e-6);
}

TEST(Aov, OrdersAddUpToThePicture) {
  const std::string ball = R"(<shape type="sphere"><bsdf type="null"/><medium name="interior" type="homogeneous">
    <float name="sigma_t" value="3"/><float name="albedo" value="0.95"/></medium></shape>)";
  const std::string orders = "o0:unscattered,o1:single_scattering,o2:double_scattering,o3:multiple_scattering";
  const Film film = render_text(scene_with(aov(orders), ball + kWall), 16);
  const Film plain = render_text(scene_with("<integrator type=\"volpath\"/>", ball + kWall), 16);
  const Film single =
      render_text(scene_with("<integrator type=\"volpath\"><integer name=\"min_scattering\" value=\"1\"/><integer "
                             "name=\"max_scattering\" value=\"1\"/></integrator>",
                             ball + kWall),
                  16);
  for (size_t i = 0; i < film.pixel_count(); ++i) {
    EXPECT_EQ(film.pixel(i).radiance[1], plain.pixel(i).radiance[1]);  // the picture is untouched
    const double sum =
        layer(film, "o0.G", i) + layer(film, "o1.G", i) + layer(film, "o2.G", i) + layer(film, "o3.G", i);
    EXPECT_NEAR(sum, plain.pixel(i).radiance[1] / 16, 1e-5 * sum);
    EXPECT_NEAR(layer(film, "o1.G", i), single.pixel(i).radiance[1] / 16, 1e-5 * sum);
  }
  EXPECT_GT(layer(film, "o3.G"), 0);
}

TEST(Aov, NeedsNoIntegrator) {
  const Film film = render_text(scene_with(aov("d:depth", ""), kWall), 16);
  EXPECT_NEAR(layer(film, "d.T"), 7, 0.02);
  EXPECT_EQ(film.pixel(kMiddle).radiance[0], 0);
}

TEST(Aov, CropsShowTheSameSamples) {
  const std::string integrator = aov("p:position");
  std::string cropped = scene_with(integrator, kWall);
  const std::string film_tag = "<film type=\"hdrfilm\">";
  cropped.insert(cropped.find(film_tag) + film_tag.size(),
                 "<integer name=\"crop_offset_x\" value=\"2\"/><integer name=\"crop_offset_y\" value=\"2\"/><integer "
                 "name=\"crop_width\" value=\"1\"/><integer name=\"crop_height\" value=\"1\"/>");
  EXPECT_EQ(layer(render_text(cropped, 8), "p.X", 0), layer(render_text(scene_with(integrator, kWall), 8), "p.X"));
}

std::string complaint(const std::string& integrator) {
  try {
    render_text(scene_with(integrator, kWall), 1);
  } catch (const SceneError& error) {
    return error.reason();
  }
  return {};
}

TEST(Aov, RefusesWhatItDoesNotKnow) {
  EXPECT_EQ(complaint(aov("d")), "'aovs' of integrator 'aov' expects NAME:TYPE, found 'd'");
  EXPECT_EQ(complaint(aov("d:dpeth")),
            "'aovs' of integrator 'aov' has the unknown type 'dpeth', did you mean 'depth'?");
  EXPECT_EQ(complaint(aov("d:depth,d:depth")), "'aovs' of integrator 'aov' gives the name 'd' twice");
  EXPECT_EQ(complaint(aov("d:duv_dx")), "'aovs' of integrator 'aov' has a type that is not supported: 'duv_dx'");
  EXPECT_EQ(complaint(aov("s:single_scattering", "")),
            "'aovs' of integrator 'aov' asks for scattering orders, which only an integrator inside can tell");
  EXPECT_EQ(
      complaint("<integrator type=\"aov\"/>"),
      "integrator 'aov' needs the parameter 'aovs' (a string: NAME:TYPE, ... with the types albedo, depth, "
      "position, uv, geo_normal, sh_normal, dp_du, dp_dv, prim_index, shape_index, unscattered, single_scattering, "
      "double_scattering, multiple_scattering)");
}

}  // namespace
}  // namespace turbid::testing
