// Emitters: where light comes from.
#include "emitter/area_light.h"
#include "emitter/collimated_beam.h"
#include "emitter/constant_environment.h"
#include "emitter/directional_light.h"
#include "emitter/environment_map.h"
#include "emitter/point_light.h"
#include "emitter/projector.h"
#include "emitter/spot_light.h"
#include "image/image_file.h"
#include "scene/builder.h"
#include "scene/fov_reader.h"
#include "texture/bitmap.h"

namespace turbid {
namespace {

using EmitterTable = PluginTable<std::shared_ptr<Emitter>, Builder, const EmitterPlace>;
using EmitterPtr = std::shared_ptr<Emitter>;
using enum ParameterType;

const Parameter kToWorld{"to_world", kTransform, "identity", "from the emitter's own space"};
const Parameter kWeight{"sampling_weight", kFloat, "1", "accepted; lights are chosen by their power", kNonNegative};
const Parameter kInMedium{"medium", kMedium, kOptional, "accepted; media are found where the light passes"};

void refuse_shape(const Properties& p, const EmitterPlace& place) {
  if (place.shape)
    throw SceneError(p.node().where, p.node().describe() + " cannot stand inside a shape, only 'area' can");
}

void refuse_both(const Properties& p, const char* first, const char* second) {
  if (p.has(first) && p.has(second)) p.refuse(first, "cannot stand beside '" + std::string(second) + "'");
}

EmitterPtr make_point(const Properties& p, Builder& b, const EmitterPlace& place) {
  refuse_shape(p, place);
  refuse_both(p, "position", "to_world");
  const Vec3 position = p.has("position") ? p.vector("position") : p.transform("to_world").point(Vec3(0));
  return std::make_shared<PointLight>(position, b.spectrum(p, "intensity"));
}

EmitterPtr make_spot(const Properties& p, Builder& b, const EmitterPlace& place) {
  refuse_shape(p, place);
  const float cutoff = p.number("cutoff_angle");
  const float beam = p.has("beam_width") ? p.number("beam_width") : 0.75f * cutoff;
  if (beam > cutoff) p.refuse("beam_width", "is larger than 'cutoff_angle'");
  return std::make_shared<SpotLight>(p.transform("to_world"), b.spectrum(p, "intensity"), cutoff, beam,
                                     b.texture(p, "texture"));
}

EmitterPtr make_projector(const Properties& p, Builder& b, const EmitterPlace& place) {
  refuse_shape(p, place);
  const auto irradiance = b.texture(p, "irradiance");
  const auto picture = std::dynamic_pointer_cast<const BitmapTexture>(irradiance);
  const double aspect = picture ? static_cast<double>(picture->width()) / picture->height() : 1;
  return std::make_shared<Projector>(p.transform("to_world"), irradiance, p.number("scale"),
                                     read_horizontal_fov(p, aspect), aspect);
}

std::vector<Parameter> projector_parameters() {
  std::vector<Parameter> result = {
      {"irradiance", kTexture, kRequired, "the picture: over pi, W/m^2 on a plane across the axis at distance 1",
       kNonNegative},
      {"scale", kFloat, "1", "factor", kNonNegative}};
  result.insert(result.end(), field_of_view_parameters().begin(), field_of_view_parameters().end());
  result.insert(result.end(), {kToWorld, kInMedium, kWeight});
  return result;
}

EmitterPtr make_directional(const Properties& p, Builder& b, const EmitterPlace& place) {
  refuse_shape(p, place);
  refuse_both(p, "direction", "to_world");
  const Vec3 direction = p.has("direction") ? p.vector("direction") : p.transform("to_world").vector({0, 0, 1});
  return std::make_shared<DirectionalLight>(direction, b.spectrum(p, "irradiance"));
}

EmitterPtr make_collimated(const Properties& p, Builder& b, const EmitterPlace& place) {
  refuse_shape(p, place);
  return std::make_shared<CollimatedBeam>(p.transform("to_world"), b.spectrum(p, "power"), p.number("radius"));
}

EmitterPtr make_area(const Properties& p, Builder& b, const EmitterPlace& place) {
  if (!place.shape) throw SceneError(p.node().where, "emitter 'area' must stand inside the shape that shines");
  return std::make_shared<AreaLight>(place.shape, b.texture(p, "radiance"));
}

EmitterPtr make_constant(const Properties& p, Builder& b, const EmitterPlace& place) {
  refuse_shape(p, place);
  return std::make_shared<ConstantEnvironment>(b.spectrum(p, "radiance"));
}

EmitterPtr make_environment(const Properties& p, Builder& b, const EmitterPlace& place) {
  refuse_shape(p, place);
  const std::string path = b.file(p, "filename");
  const Image image = read_image(path);
  const std::vector<std::span<const float>> channels = color_channels(image, path);
  std::vector<Spectrum> pixels(image.pixel_count());
  for (size_t i = 0; i < pixels.size(); ++i) pixels[i] = {channels[0][i], channels[1][i], channels[2][i]};
  return std::make_shared<EnvironmentMap>(std::move(pixels), image.width(), image.height(), p.transform("to_world"),
                                          p.number("scale"));
}

}  // namespace

const EmitterTable& emitter_table() {
  static const EmitterTable table(
      Category::kEmitter,
      {{.name = "point",
        .summary = "A point that shines alike in all directions.",
        .parameters = {{"intensity", kSpectrum, "1", "W/sr", kNonNegative},
                       {"position", kPoint, kOptional, "in the world; or to_world"},
                       kToWorld,
                       kInMedium,
                       kWeight},
        .make = make_point},
       {.name = "spot",
        .summary = "A point that shines into a cone about its +z axis.",
        .parameters = {{"intensity", kSpectrum, "1", "W/sr on the axis", kNonNegative},
                       {"cutoff_angle",
                        kFloat,
                        "20",
                        "from the axis to darkness, degrees",
                        {.min = 0, .max = 180, .open_min = true}},
                       {"beam_width",
                        kFloat,
                        kOptional,
                        "full intensity up to this angle, degrees; 3/4 of cutoff_angle",
                        {.min = 0, .max = 180}},
                       {"texture", kTexture, kOptional, "projected picture that multiplies the intensity",
                        kNonNegative},
                       kToWorld,
                       kInMedium,
                       kWeight},
        .make = make_spot},
       {.name = "projector",
        .summary = "A point that throws a picture along its +z axis.",
        .parameters = projector_parameters(),
        .make = make_projector},
       {.name = "directional",
        .summary = "Parallel light from infinity.",
        .parameters = {{"irradiance", kSpectrum, "1", "W/m^2 across the direction", kNonNegative},
                       {"direction", kVector, kOptional, "in which the light travels; or to_world: its +z axis"},
                       kToWorld,
                       kWeight},
        .make = make_directional},
       {.name = "collimated",
        .summary = "A laser: parallel light along its +z axis from a disk. Only paths from lights find it.",
        .parameters = {{"power", kSpectrum, "1", "W", kNonNegative},
                       {"radius", kFloat, "0", "of the disk, scene units; 0: a single ray", kNonNegative},
                       kToWorld,
                       kInMedium,
                       kWeight},
        .make = make_collimated},
       {.name = "area",
        .summary = "A shape that shines from its outside.",
        .parameters = {{"radiance", kTexture, "1", "W/(sr m^2)", kNonNegative}, kInMedium, kWeight},
        .make = make_area},
       {.name = "constant",
        .summary = "The same radiance from all directions at infinity.",
        .parameters = {{"radiance", kSpectrum, "1", "W/(sr m^2)", kNonNegative}, kWeight},
        .make = make_constant},
       {.name = "envmap",
        .summary = "A picture at infinity, in latitude and longitude, +y up.",
        .parameters = {{"filename", kFile, kRequired, "EXR, HDR ..."},
                       {"scale", kFloat, "1", "factor of the radiance", kNonNegative},
                       {"mis_compensation", kBoolean, "false", "accepted; no effect"},
                       kToWorld,
                       kWeight},
        .make = make_environment}},
      {"sky", "sun", "sunsky", "directionalarea", "volumelight", "timed_sunsky"});
  return table;
}

}  // namespace turbid
