// Sensors: where pictures are taken from.
#include "scene/builder.h"
#include "scene/fov_reader.h"
#include "sensor/orthographic.h"
#include "sensor/perspective.h"
#include "sensor/thin_lens.h"

namespace turbid {
namespace {

using SensorTable = PluginTable<std::shared_ptr<const Sensor>, Builder, const FilmSettings>;
using enum ParameterType;
using Parameters = std::vector<Parameter>;

const Parameters kCommon = {{"to_world", kTransform, "identity", "from the sensor's space: looks along +z, +y is up"},
                            {"near_clip", kFloat, "0.01", "nearest visible distance along the axis", kNonNegative},
                            {"far_clip", kFloat, "10000", "farthest visible distance along the axis", kPositive},
                            {"film", kFilm, kOptional, "left out: hdrfilm"},
                            {"sampler", kSampler, kOptional, "left out: independent"},
                            {"medium", kMedium, kOptional, "that the sensor stands in; left out: found by a ray"},
                            {"focus_distance", kFloat, kOptional, "of the sharp plane, along the axis", kPositive},
                            {"shutter_open", kFloat, "0", "accepted; nothing moves"},
                            {"shutter_close", kFloat, "0", "accepted; nothing moves"}};
const Parameters kPrincipalPoint = {
    {"principal_point_offset_x", kFloat, "0", "of the optical axis from the film's middle, in widths"},
    {"principal_point_offset_y", kFloat, "0", "of the optical axis from the film's middle, in heights"}};

Parameters join(Parameters first, const Parameters& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

double aspect_of(const FilmSettings& film) {
  return static_cast<double>(film.size.x) / static_cast<double>(film.size.y);
}

ClipRange clip_of(const Properties& p) {
  const ClipRange clip{p.number("near_clip"), p.number("far_clip")};
  if (clip.near_clip >= clip.far_clip) p.refuse("near_clip", "is not nearer than 'far_clip'");
  return clip;
}

std::shared_ptr<const Sensor> make_perspective(const Properties& p, Builder&, const FilmSettings& film) {
  const Vec2 offset(p.number("principal_point_offset_x"), p.number("principal_point_offset_y"));
  return std::make_shared<PerspectiveSensor>(p.transform("to_world"), read_horizontal_fov(p, aspect_of(film)),
                                             aspect_of(film), clip_of(p), offset);
}

std::shared_ptr<const Sensor> make_thin_lens(const Properties& p, Builder&, const FilmSettings& film) {
  const float focus = p.number(p.has("focus_distance") ? "focus_distance" : "far_clip");
  return std::make_shared<ThinLensSensor>(p.transform("to_world"), read_horizontal_fov(p, aspect_of(film)),
                                          aspect_of(film), p.number("aperture_radius"), focus, clip_of(p));
}

std::shared_ptr<const Sensor> make_orthographic(const Properties& p, Builder&, const FilmSettings& film) {
  return std::make_shared<OrthographicSensor>(p.transform("to_world"), aspect_of(film), clip_of(p));
}

}  // namespace

const SensorTable& sensor_table() {
  static const SensorTable table(
      Category::kSensor,
      {{.name = "perspective",
        .summary = "A pinhole.",
        .parameters = join(join(field_of_view_parameters(), kPrincipalPoint), kCommon),
        .make = make_perspective},
       {.name = "thinlens",
        .summary = "A lens with an aperture: what lies at focus_distance is sharp.",
        .parameters = join(
            join({{"aperture_radius", kFloat, kRequired, "scene units", kNonNegative}}, field_of_view_parameters()),
            kCommon),
        .make = make_thin_lens},
       {.name = "orthographic",
        .summary = "Parallel rays; to_world's scale sets the size of the view, [-1, 1] across.",
        .parameters = kCommon,
        .make = make_orthographic}},
      {"radiancemeter", "irradiancemeter", "fluxmeter", "distant", "batch"});
  return table;
}

}  // namespace turbid
