// What stands inside a sensor: film, reconstruction filter, sampler.
#include "scene/builder.h"

namespace turbid {
namespace {

using FilmTable = PluginTable<FilmSettings, Builder>;
using SamplerTable = PluginTable<SamplerSettings, Builder>;
using FilterTable = PluginTable<ReconstructionFilter, Builder>;
using enum ParameterType;

constexpr Range kPixels{1, 1 << 20};
constexpr Range kOffset{0, 1 << 20};
constexpr Range kSteps{2, 64};

int pixels(const Properties& p, const char* name) { return static_cast<int>(p.integer(name)); }

FilmSettings make_film(const Properties& p, Builder& b) {
  FilmSettings film;
  film.size = {pixels(p, "width"), pixels(p, "height")};
  film.crop_offset = {pixels(p, "crop_offset_x"), pixels(p, "crop_offset_y")};
  const bool crop = p.has("crop_width") || p.has("crop_height") || p.has("crop_offset_x") || p.has("crop_offset_y");
  if (crop) {
    film.crop_size.x = p.has("crop_width") ? pixels(p, "crop_width") : film.size.x - film.crop_offset.x;
    film.crop_size.y = p.has("crop_height") ? pixels(p, "crop_height") : film.size.y - film.crop_offset.y;
    const Vec2i end = film.crop_offset + film.crop_size;
    const bool inside = film.crop_size.x > 0 && film.crop_size.y > 0 && end.x <= film.size.x && end.y <= film.size.y;
    if (!inside) throw SceneError(p.node().where, "the crop window does not lie inside the film");
  }
  const std::string format = p.string("pixel_format");
  film.alpha = format == "rgba" || format == "luminance_alpha" || format == "xyza";
  if (p.string("outlier_rejection") == "reweight")
    film.outliers = {p.number("outlier_start"), p.number("outlier_base"), p.number("outlier_kappa")};
  const SceneNode* filter = p.child("rfilter");
  film.filter = filter ? filter_table().make(*filter, &b.document(), b)
                       : ReconstructionFilter(ReconstructionFilter::Kind::kGaussian, 0.5f);
  return film;
}

SamplerSettings make_sampler(const Properties& p, SamplerKind kind) {
  return {kind, static_cast<uint32_t>(p.integer("sample_count"))};
}

const Parameter kSampleCount{"sample_count", kInteger, "4", "samples per pixel, unless --spp says otherwise",
                             Range{1, 4294967295.0}};
const Parameter kSeed{"seed", kInteger, "0", "accepted; --seed sets it"};

}  // namespace

const FilmTable& film_table() {
  static const FilmTable table(
      Category::kFilm,
      {{.name = "hdrfilm",
        .summary = "A picture of linear RGB floats.",
        .parameters = {{"width", kInteger, "768", "pixels", kPixels},
                       {"height", kInteger, "576", "pixels", kPixels},
                       {"crop_offset_x", kInteger, "0", "pixels from the left", kOffset},
                       {"crop_offset_y", kInteger, "0", "pixels from the top", kOffset},
                       {"crop_width", kInteger, kOptional, "pixels; left out: to the right edge", kPixels},
                       {"crop_height", kInteger, kOptional, "pixels; left out: to the bottom", kPixels},
                       {"rfilter", kFilter, kOptional, "left out: gaussian"},
                       {.name = "pixel_format",
                        .type = kString,
                        .default_text = "rgb",
                        .meaning = "with alpha or without; colours are always RGB",
                        .choices = {"rgb", "rgba", "luminance", "luminance_alpha", "xyz", "xyza"}},
                       {.name = "outlier_rejection",
                        .type = kString,
                        .default_text = "none",
                        .meaning = "reweight: weighs fireflies down by how few samples are like them (Zirr et al. "
                                   "2018); darker where samples are few, and the mean is kept in layers unweighted.*",
                        .choices = {"none", "reweight"}},
                       {"outlier_start", kFloat, "1", "luminance that no outlier lies below", kPositive},
                       {"outlier_base", kFloat, "8", "ratio of the steps by which samples are told apart", kSteps},
                       {"outlier_kappa", kFloat, "1",
                        "samples of a kind that make it trusted; more: darker, less noise", kPositive},
                       {"file_format", kString, "openexr", "accepted; always OpenEXR"},
                       {"component_format", kString, "float32", "accepted; always float32"},
                       {"filename", kString, kOptional, "accepted; -o names the file"},
                       {"sample_border", kBoolean, "false", "accepted; pixels at the border are complete"},
                       {"compensate", kBoolean, "false", "accepted; sums are kept in double precision"}},
        .make = make_film}},
      {"specfilm"});
  return table;
}

const SamplerTable& sampler_table() {
  static const SamplerTable table(
      Category::kSampler,
      {{.name = "independent",
        .summary = "Uniform random numbers.",
        .parameters = {kSampleCount, kSeed},
        .make = [](const Properties& p, Builder&) { return make_sampler(p, SamplerKind::kIndependent); }},
       {.name = "sobol",
        .aliases = {"multijitter", "stratified", "ldsampler", "orthogonal"},
        .summary = "Owen-scrambled Sobol points; stands in for Mitsuba's stratified samplers.",
        .parameters = {kSampleCount,
                       kSeed,
                       {"jitter", kBoolean, "true", "accepted; no effect"},
                       {"strength", kInteger, "2", "accepted; no effect"}},
        .make = [](const Properties& p, Builder&) {
          if (p.node().type != "sobol") log_notice(p.node().describe() + " is replaced by 'sobol'");
          return make_sampler(p, SamplerKind::kSobol);
        }}});
  return table;
}

const FilterTable& filter_table() {
  using Kind = ReconstructionFilter::Kind;
  static const FilterTable table(
      Category::kFilter,
      {{.name = "box",
        .summary = "The mean over the pixel.",
        .parameters = {{"radius", kFloat, "0.5", "half the width, pixels", kPositive}},
        .make = [](const Properties& p, Builder&) { return ReconstructionFilter(Kind::kBox, p.number("radius")); }},
       {.name = "tent",
        .summary = "A triangle.",
        .parameters = {{"radius", kFloat, "1", "half the width, pixels", kPositive}},
        .make = [](const Properties& p, Builder&) { return ReconstructionFilter(Kind::kTent, p.number("radius")); }},
       {.name = "gaussian",
        .summary = "A Gaussian, cut off at 4 standard deviations.",
        .parameters = {{"stddev", kFloat, "0.5", "standard deviation, pixels", kPositive}},
        .make = [](const Properties& p,
                   Builder&) { return ReconstructionFilter(Kind::kGaussian, p.number("stddev")); }}},
      {"mitchell", "catmullrom", "lanczos"});
  return table;
}

}  // namespace turbid
