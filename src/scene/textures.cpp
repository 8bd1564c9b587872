// Textures: quantities that vary over a surface.
#include <fmt/format.h>

#include "scene/builder.h"
#include "scene/values.h"
#include "texture/bitmap.h"
#include "texture/checkerboard.h"
#include "texture/constant.h"
#include "texture/mesh_attribute.h"
#include "texture/strokes.h"

namespace turbid {
namespace {

using TextureTable = PluginTable<TexturePtr, Builder>;
using enum ParameterType;

TexturePtr constant(const Spectrum& value) { return std::make_shared<ConstantTexture>(value); }

TexturePtr make_bitmap(const Properties& p, Builder& builder) {
  BitmapSettings settings;
  settings.filter = p.string("filter_type") == "nearest" ? BitmapFilter::kNearest : BitmapFilter::kBilinear;
  const std::string wrap = p.string("wrap_mode");
  settings.wrap = wrap == "mirror" ? BitmapWrap::kMirror : wrap == "clamp" ? BitmapWrap::kClamp : BitmapWrap::kRepeat;
  settings.raw = p.boolean("raw");
  settings.to_uv = UvTransform(p.transform("to_uv"));
  const std::string path = builder.file(p, "filename");
  std::string key = path + '\n' + p.string("filter_type") + wrap + (settings.raw ? "raw" : "");
  const Transform to_uv = p.transform("to_uv");
  for (int i = 0; i < 16; ++i) key += fmt::format(" {}", to_uv.at(i / 4, i % 4));
  return builder.picture(key, [&] { return std::make_shared<BitmapTexture>(path, settings); });
}

TexturePtr make_strokes(const Properties& p, Builder& b) {
  const std::vector<double> numbers = read_numbers(p.string("points"), p.where("points"));
  if (numbers.empty() || numbers.size() % 4 != 0)
    p.refuse("points", fmt::format("takes four numbers for each stroke, found {}", numbers.size()));
  std::vector<Stroke> strokes;
  const auto number = [&](size_t i) { return static_cast<float>(numbers[i]); };
  for (size_t i = 0; i < numbers.size(); i += 4)
    strokes.push_back({{number(i), number(i + 1)}, {number(i + 2), number(i + 3)}});
  return std::make_shared<StrokesTexture>(std::move(strokes), p.number("width"), b.texture(p, "color0"),
                                          b.texture(p, "color1"), UvTransform(p.transform("to_uv")));
}

const Parameter kToUv{"to_uv", kTransform, "identity", "maps surface parameters before the look-up"};

}  // namespace

const TextureTable& texture_table() {
  static const TextureTable table(
      Category::kTexture,
      {{.name = "constant",
        .aliases = {"uniform"},
        .summary = "The same value everywhere.",
        .parameters = {{"value", kSpectrum, "1", "the value"}},
        .make = [](const Properties& p, Builder& b) { return constant(b.spectrum(p, "value")); }},
       {.name = "rgb",
        .aliases = {"srgb"},
        .summary = "The same colour everywhere.",
        .parameters = {{"color", kSpectrum, kRequired, "linear RGB"},
                       {"unbounded", kBoolean, "false",
                        "accepted; values above 1 are refused where they make no sense"}},
        .make = [](const Properties& p, Builder& b) { return constant(b.spectrum(p, "color")); }},
       {.name = "rawconstant",
        .summary = "The same plain numbers everywhere, for normal maps and the like.",
        .parameters = {{"value", kFloatOrVector, kRequired, "one number or three"}},
        .make = [](const Properties& p, Builder&) { return constant(p.spectrum("value")); }},
       {.name = "d65",
        .aliases = {"srgb_d65"},
        .summary = "White light of standard illuminant D65: white in RGB.",
        .parameters = {{"color", kSpectrum, "1", "colour that multiplies it, linear RGB"},
                       {"scale", kFloat, "1", "factor"}},
        .make = [](const Properties& p, Builder& b) { return constant(b.spectrum(p, "color") * p.number("scale")); }},
       {.name = "bitmap",
        .summary = "A picture over the uv square.",
        .parameters = {{"filename", kFile, kRequired, "EXR, PNG, JPEG, BMP, TGA or HDR"},
                       {"raw", kBoolean, "false", "the file holds plain numbers: no sRGB decoding"},
                       {.name = "filter_type",
                        .type = kString,
                        .default_text = "bilinear",
                        .meaning = "between pixels",
                        .choices = {"bilinear", "nearest"}},
                       {.name = "wrap_mode",
                        .type = kString,
                        .default_text = "repeat",
                        .meaning = "beyond the picture",
                        .choices = {"repeat", "mirror", "clamp"}},
                       kToUv,
                       {"accel", kBoolean, "true", "accepted; no effect"},
                       {"format", kString, "variant", "accepted; no effect"}},
        .make = make_bitmap},
       {.name = "checkerboard",
        .summary = "Squares of two colours, two by two in the uv square.",
        .parameters = {{"color0", kTexture, "0.4", "where both or neither of u and v lie in the upper half"},
                       {"color1", kTexture, "0.2", "elsewhere"},
                       kToUv},
        .make =
            [](const Properties& p, Builder& b) {
              return std::make_shared<CheckerboardTexture>(b.texture(p, "color0"), b.texture(p, "color1"),
                                                           UvTransform(p.transform("to_uv")));
            }},
       {.name = "strokes",
        .summary = "Straight strokes of a pen on a ground: letters, emblems, grids.",
        .parameters = {{"points", kString, kRequired, "u and v of both ends of each stroke: four numbers"},
                       {"width", kFloat, "0.02", "of the strokes, in units of uv", kPositive},
                       {"color0", kTexture, "0.4", "of the strokes"},
                       {"color1", kTexture, "0.2", "of the ground"},
                       kToUv},
        .make = make_strokes},
       {.name = "mesh_attribute",
        .summary = "Numbers that a mesh carries on its vertices or faces.",
        .parameters = {{"name", kString, kRequired, "of the attribute: vertex_color, face_weight ..."},
                       {"scale", kFloat, "1", "factor"}},
        .make = [](const Properties& p,
                   Builder&) { return std::make_shared<MeshAttributeTexture>(p.string("name"), p.number("scale")); }}},
      {"volume", "regular", "irregular", "blackbody", "sunsky"});
  return table;
}

}  // namespace turbid
