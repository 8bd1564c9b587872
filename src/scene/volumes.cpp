// Volumes: quantities that vary in space; and the medium that is made of them.
#include "medium/heterogeneous.h"
#include "medium/isotropic.h"
#include "scene/builder.h"
#include "texture/blackbody.h"
#include "texture/constant_volume.h"
#include "texture/grid_volume.h"
#include "texture/vdb_file.h"
#include "texture/vol_file.h"

namespace turbid {
namespace {

using VolumePtr = std::shared_ptr<const Volume>;
using VolumeTable = PluginTable<VolumePtr, Builder>;
using enum ParameterType;

GridFilter filter_of(const Properties& p) {
  return p.string("filter_type") == "nearest" ? GridFilter::kNearest : GridFilter::kTrilinear;
}

VolumePtr make_grid(const Properties& p, Builder& b) {
  VolFile file = read_vol(b.file(p, "filename"));
  const std::string wrap = p.string("wrap_mode");
  GridSettings settings;
  settings.filter = filter_of(p);
  settings.wrap = wrap == "mirror" ? GridWrap::kMirror : wrap == "repeat" ? GridWrap::kRepeat : GridWrap::kClamp;
  settings.to_world = p.transform("to_world");
  if (p.boolean("use_grid_bbox")) {
    const Vec3 low = file.box.min, size = file.box.max - low;
    if (!(size.x > 0 && size.y > 0 && size.z > 0 && length(low) < kInfinity && length(size) < kInfinity))
      p.refuse("use_grid_bbox", "asks for the box of a file whose box is empty");
    settings.to_world = settings.to_world * Transform::translate(double(low.x), double(low.y), double(low.z)) *
                        Transform::scale(double(size.x), double(size.y), double(size.z));
  }
  return std::make_shared<GridVolume>(std::move(file.voxels), settings);
}

VolumePtr make_vdb(const Properties& p, Builder& b) {
  VdbGrid grid = read_vdb(b.file(p, "filename"), p.string("grid"));
  GridSettings settings;
  settings.filter = filter_of(p);
  settings.to_world = p.transform("to_world") * grid.to_world;
  return std::make_shared<GridVolume>(std::move(grid.voxels), settings);
}

std::shared_ptr<const Medium> make_heterogeneous(const Properties& p, Builder& b) {
  HeterogeneousParts parts;
  parts.sigma_t = b.volume(p, "sigma_t");
  parts.albedo = b.volume(p, "albedo");
  parts.scale = p.number("scale");
  parts.emission = b.volume(p, "emission");
  parts.emission_scale = p.number("emission_scale");
  if (p.has("temperature")) {
    if (p.has("emission")) p.refuse("temperature", "cannot stand beside 'emission'");
    parts.emission = std::make_shared<BlackbodyVolume>(b.volume(p, "temperature"), 1.0f);
    parts.emission_by_absorption = true;
  }
  parts.phase = b.phase(p, "phase");
  if (!parts.phase) parts.phase = std::make_shared<IsotropicPhase>();
  const SceneNode* node = p.child("sigma_t");
  const bool placed = node && std::any_of(node->values.begin(), node->values.end(),
                                          [](const NamedValue& value) { return value.name == "to_world"; });
  if (!placed && std::dynamic_pointer_cast<const ConstantVolume>(parts.sigma_t))
    log_notice(p.node().describe() +
               ": an extinction that is the same everywhere fills only the cube from (0, 0, 0) to (1, 1, 1), as in "
               "Mitsuba 3; a 'constvolume' with 'to_world' fills another");
  return std::make_shared<HeterogeneousMedium>(parts);
}

const Parameter kFilterType{.name = "filter_type",
                            .type = kString,
                            .default_text = "trilinear",
                            .meaning = "between the centres of voxels",
                            .choices = {"trilinear", "nearest"}};

}  // namespace

const VolumeTable& volume_table() {
  static const VolumeTable table(
      Category::kVolume,
      {{.name = "constvolume",
        .summary = "The same value everywhere.",
        .parameters = {{"value", kSpectrum, "1", "the value"},
                       {"to_world", kTransform, "identity",
                        "where the unit cube goes that bounds a medium of this extinction"}},
        .make =
            [](const Properties& p, Builder& b) {
              return std::make_shared<ConstantVolume>(b.spectrum(p, "value"), p.transform("to_world"));
            }},
       {.name = "gridvolume",
        .summary = "A grid of voxels from a Mitsuba .vol file, over the unit cube.",
        .parameters = {{"filename", kFile, kRequired, "version 3; float32, float16 or uint8; 1 or 3 channels"},
                       {"to_world", kTransform, "identity", "where the unit cube goes"},
                       {"use_grid_bbox", kBoolean, "false", "the box in the file stands for the unit cube"},
                       kFilterType,
                       {.name = "wrap_mode",
                        .type = kString,
                        .default_text = "clamp",
                        .meaning = "beyond the cube",
                        .choices = {"clamp", "repeat", "mirror"}},
                       {"raw", kBoolean, "false", "accepted; no effect: values are taken as they are"},
                       {"accel", kBoolean, "true", "accepted; no effect"},
                       {"max_value", kFloat, kOptional, "accepted; no effect: the bounds of the values are found"}},
        .make = make_grid},
       {.name = "vdbvolume",
        .summary = "A grid of an OpenVDB file, where the file says that it stands.",
        .parameters = {{"filename", kFile, kRequired, ".vdb, float or vec3s grids"},
                       {"grid", kString, "density", "its name"},
                       {"to_world", kTransform, "identity", "from the file's world to the scene's"},
                       kFilterType},
        .make = make_vdb}},
      {"openvdb", "nanovdb"});
  return table;
}

Plugin<std::shared_ptr<const Medium>, Builder> heterogeneous_row() {
  return {
      .name = "heterogeneous",
      .summary = "Extinction, albedo and emission that vary in space, given by volumes.",
      .parameters = {{"sigma_t", kTexture, "1", "extinction coefficient, 1/unit; its volume bounds the medium",
                      kNonNegative},
                     {"albedo", kTexture, "0.75", "part of the extinction that scatters", kUnitInterval},
                     {"scale", kFloat, "1", "factor of the extinction", kNonNegative},
                     {"emission", kTexture, kOptional, "radiance added per unit length, W/(sr m^2 unit)", kNonNegative},
                     {"temperature", kTexture, kOptional,
                      "kelvin: what is absorbed is emitted as by a black body of this temperature", kNonNegative},
                     {"emission_scale", kFloat, "1", "factor of the emission", kNonNegative},
                     {"phase", kPhase, kOptional, "how it scatters; left out: isotropic"},
                     kPriority,
                     {"sample_emitters", kBoolean, "true", "accepted; no effect"},
                     {"has_spectral_extinction", kBoolean, "true", "accepted; no effect"}},
      .make = make_heterogeneous};
}

}  // namespace turbid
