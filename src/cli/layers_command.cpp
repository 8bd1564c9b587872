#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "cli/command.h"
#include "core/error.h"
#include "image/image_file.h"

namespace turbid {
namespace {

struct LayersWords {
  std::string image, out, match;
  float exposure = 0;
};

/// The colour layers of an image, without ".R", ".G", ".B", in the order of their R channels.
std::vector<std::string> color_layers(const Image& image, const std::string& match) {
  std::vector<std::string> layers;
  for (const std::string& name : image.channel_names()) {
    if (!name.ends_with(".R")) continue;
    const std::string layer = name.substr(0, name.size() - 2);
    if (image.has_all({layer + ".G", layer + ".B"}) && layer.starts_with(match)) layers.push_back(layer);
  }
  return layers;
}

/// Everything before the last dot: layers that share it stand in one row.
std::string family(const std::string& layer) {
  const size_t dot = layer.rfind('.');
  return dot == std::string::npos ? "" : layer.substr(0, dot);
}

/// Layers side by side, those of one family in a row, a line of grey between them.
Image make_sheet(const Image& image, const std::vector<std::string>& layers) {
  std::vector<std::vector<std::string>> rows;
  for (const std::string& layer : layers) {
    if (rows.empty() || family(rows.back().front()) != family(layer)) rows.emplace_back();
    rows.back().push_back(layer);
  }
  size_t columns = 0;
  for (const auto& row : rows) columns = std::max(columns, row.size());
  constexpr int kGap = 2;
  const int width = image.width() + kGap, height = image.height() + kGap;
  Image sheet(static_cast<int>(columns) * width - kGap, static_cast<int>(rows.size()) * height - kGap, {"R", "G", "B"});
  for (const char* color : {"R", "G", "B"}) {
    const std::span<float> to = sheet.channel(color);
    std::fill(to.begin(), to.end(), 0.2f);
    for (size_t r = 0; r < rows.size(); ++r)
      for (size_t c = 0; c < rows[r].size(); ++c) {
        const std::span<const float> from = image.channel(rows[r][c] + "." + color);
        for (int y = 0; y < image.height(); ++y)
          std::copy_n(from.begin() + y * image.width(), image.width(),
                      to.begin() + (static_cast<int>(r) * height + y) * sheet.width() + static_cast<int>(c) * width);
      }
  }
  return sheet;
}

int run_layers(const LayersWords& words) {
  const Image image = read_image(words.image);
  const std::vector<std::string> layers = color_layers(image, words.match);
  if (layers.empty())
    throw UsageError(words.image + " has no colour layers" +
                     (words.match.empty() ? "" : " whose names begin with '" + words.match + "'"));
  if (words.out.empty()) {
    for (const std::string& layer : layers) fmt::print("{}\n", layer);
    return kExitDone;
  }
  write_png(words.out, make_sheet(image, layers), words.exposure);
  return kExitDone;
}

}  // namespace

Command add_layers_command(CLI::App& app) {
  auto words = std::make_shared<LayersWords>();
  CLI::App* command = app.add_subcommand("layers", "list the colour layers of an EXR image, or show them on one sheet");
  command->add_option("IMAGE", words->image, "an EXR image")->required();
  command->add_option("-o,--out", words->out,
                      "write the sheet there (PNG): layers that differ in the last part of "
                      "their names stand in a row");
  command->add_option("--match", words->match, "only layers whose names begin so: strategy.weighted");
  command->add_option("--exposure", words->exposure, "in stops, of the sheet");
  return [words](const CommandLine&) { return run_layers(*words); };
}

}  // namespace turbid
