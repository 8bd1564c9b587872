#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "cli/command.h"
#include "core/error.h"
#include "image/atomic_file.h"
#include "image/image_file.h"
#include "image/z_test.h"
#include "report/report.h"

namespace turbid {
namespace {

/// The words after `turbid compare`.
struct CompareWords {
  std::vector<std::string> paths;  ///< the reference last
  std::string variance;
  std::optional<uint64_t> spp;
  bool json = false;
  std::optional<std::string> html;

  const std::string& reference() const { return paths.back(); }
};

void require_same_size(const Image& a, const std::string& path_a, const Image& b, const std::string& path_b) {
  if (a.width() == b.width() && a.height() == b.height()) return;
  throw FileError(
      path_a, fmt::format("is {} x {} pixels, {} is {} x {}", a.width(), a.height(), path_b, b.width(), b.height()));
}

/// Variance of one sample in XYZ: from layers m2_* and the mean beside them (moment integrator), else from a *_var.exr.
XyzImage read_variance(const Image& image, const std::string& path) {
  for (const std::string& name : image.channel_names()) {
    if (!name.starts_with("m2_") || !name.ends_with(".X")) continue;
    const std::string layer = name.substr(3, name.size() - 4);  // with the dot
    XyzImage variance;
    for (size_t c = 0; c < 3; ++c) {
      const std::string component = layer + "XYZ"[c];
      if (!image.has_all({component, "m2_" + component}))
        throw FileError(path, "has no channels '" + component + "' and 'm2_" + component + "'");
      const auto mean = image.channel(component), second = image.channel("m2_" + component);
      variance[c].resize(mean.size());
      for (size_t i = 0; i < mean.size(); ++i) {
        const auto m = static_cast<double>(mean[i]);
        variance[c][i] = static_cast<double>(second[i]) - m * m;
      }
    }
    return variance;
  }
  return to_xyz(color_channels(image, path));
}

/// A number that the image's file says.
std::optional<double> number_in(const Metadata& metadata, const std::string& name) {
  const auto found = metadata.find(name);
  double number = 0;
  if (found == metadata.end()) return {};
  const std::string& text = found->second;
  if (std::from_chars(text.data(), text.data() + text.size(), number).ec != std::errc()) return {};
  return number;
}

/// Samples per pixel of the image, as given or as its metadata say.
uint64_t samples_of(const CompareWords& words, const std::string& path, const Image& image) {
  if (words.spp) return *words.spp;
  const uint64_t samples = static_cast<uint64_t>(number_in(image.metadata, "samples").value_or(0));
  if (samples == 0) throw UsageError("--variance needs --spp: " + path + " does not say how many samples a pixel has");
  return samples;
}

/// How far an image is from the reference.
struct Comparison {
  std::string path;
  Image image;
  ImageMetrics metrics;
  std::optional<ZTestResult> verdict{};
  uint64_t spp = 0;  ///< of the z-test
};

void print_text(const Comparison& comparison, bool named) {
  const ImageMetrics& m = comparison.metrics;
  if (named) fmt::print("{}\n", comparison.path);
  fmt::print("RMSE        {:.6g}\nPSNR        {:.4g} dB (peak {:.6g})\nrelMSE      {:.6g}\nMAE         {:.6g}\n",
             m.rmse, m.psnr, m.peak, m.rel_mse, m.mae);
  fmt::print("mean ratio  {:.6g} ({:.6g})\n", m.mean_ratio, fmt::join(m.channel_mean_ratios, ", "));
  if (m.non_finite > 0) fmt::print("not finite  {} values, left out\n", m.non_finite);
  if (!comparison.verdict) return;
  const ZTestResult& z = *comparison.verdict;
  const auto width = static_cast<size_t>(comparison.image.width());
  fmt::print(
      "z-test      {}: {:.3f} % of the tests pass ({:.2f} % needed), {} samples per pixel, worst |z| {:.3g} at pixel "
      "({}, {})\n",
      z.accepted() ? "accepted" : "REJECTED", 100 * z.pass_fraction(), 100 * ZTestResult::kAcceptedFraction,
      comparison.spp, z.worst_z, z.worst_index % width, z.worst_index / width);
}

nlohmann::ordered_json to_json(const Comparison& comparison, bool named) {
  const ImageMetrics& m = comparison.metrics;
  nlohmann::ordered_json json;
  if (named) json["image"] = comparison.path;
  json.update({{"rmse", m.rmse},
               {"psnr", m.psnr},
               {"peak", m.peak},
               {"rel_mse", m.rel_mse},
               {"mae", m.mae},
               {"mean_ratio", m.mean_ratio},
               {"channel_mean_ratios", m.channel_mean_ratios},
               {"non_finite", m.non_finite}});
  if (comparison.verdict) {
    const ZTestResult& z = *comparison.verdict;
    const auto width = static_cast<size_t>(comparison.image.width());
    json["z_test"] = {{"accepted", z.accepted()},
                      {"pass_fraction", z.pass_fraction()},
                      {"samples_per_pixel", comparison.spp},
                      {"level", z.level},
                      {"smallest_p", z.smallest_p},
                      {"worst_z", z.worst_z},
                      {"worst_pixel", {z.worst_index % width, z.worst_index / width}}};
  }
  return json;
}

/// Names without what they have in common: the file names, or the paths where file names are alike.
std::vector<std::string> short_names(const std::vector<std::string>& paths) {
  std::vector<std::string> names;
  for (const std::string& path : paths) names.push_back(std::filesystem::path(path).filename().replace_extension());
  const std::set<std::string> distinct(names.begin(), names.end());
  return distinct.size() == names.size() ? names : paths;
}

void write_page(const CompareWords& words, std::vector<Comparison> comparisons, Image reference,
                const CommandLine& command_line) {
  const std::vector<std::string> names = short_names(words.paths);
  ReportGroup group;
  for (size_t i = 0; i < comparisons.size(); ++i) {
    Comparison& comparison = comparisons[i];
    const Metadata& metadata = comparison.image.metadata;
    const auto seconds = number_in(metadata, "seconds"), samples = number_in(metadata, "samples");
    group.images.push_back({.name = names[i],
                            .image = std::move(comparison.image),
                            .metrics = comparison.metrics,
                            .seconds = seconds,
                            .samples = samples});
  }
  group.images.push_back({.name = names.back(), .image = std::move(reference), .is_reference = true});
  const Report report{
      .title = fmt::format("{} against {}", fmt::join(names.begin(), names.end() - 1, ", "), names.back()),
      .groups = {std::move(group)},
      .facts = {{"command", command_line}}};
  const std::string page = to_html(report, read_viewer());
  write_file_atomically(*words.html, page);
  fmt::print(stderr, "wrote {}\n", *words.html);
}

int run_compare(const CompareWords& words, const CommandLine& command_line) {
  if (words.paths.size() < 2) throw UsageError("compare needs at least an image and, last, the REFERENCE");
  if (words.spp && words.variance.empty()) throw UsageError("--spp means something only with --variance");
  std::vector<Comparison> comparisons;
  for (const std::string& path : words.paths) comparisons.push_back({path, read_image(path), {}});
  Image reference = std::move(comparisons.back().image);
  comparisons.pop_back();
  const std::string& path = words.reference();
  const ChannelList truth = color_channels(reference, path);
  for (Comparison& made : comparisons) {
    require_same_size(made.image, made.path, reference, path);
    const ChannelList channels = color_channels(made.image, made.path);
    made.metrics = compare_images(channels, truth);
    if (words.variance.empty()) continue;
    const Image variance = read_image(words.variance);
    require_same_size(variance, words.variance, reference, path);
    made.spp = samples_of(words, made.path, made.image);
    made.verdict = z_test(to_xyz(channels), made.spp, to_xyz(truth), read_variance(variance, words.variance));
  }
  const bool several = comparisons.size() > 1;
  if (words.json) {
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    for (const Comparison& comparison : comparisons) all.push_back(to_json(comparison, several));
    fmt::print("{}\n", (several ? all : all[0]).dump(2));
  } else {
    for (const Comparison& comparison : comparisons) print_text(comparison, several);
  }
  if (words.html) write_page(words, std::move(comparisons), std::move(reference), command_line);
  return kExitDone;
}

}  // namespace

Command add_compare_command(CLI::App& app) {
  auto words = std::make_shared<CompareWords>();
  CLI::App* command = app.add_subcommand("compare", "say how far images are from a reference");
  command->add_option("IMAGES", words->paths, "the images to judge, then what they should be")
      ->required()
      ->expected(1, 1 << 16)
      ->type_name("IMAGE... REFERENCE");
  command->add_option("--variance", words->variance,
                      "variance of one sample, for a z-test per pixel: a *_var.exr, or an image with layers m2_*");
  command->add_option("--spp", words->spp, "samples per pixel of IMAGE, when it does not say")
      ->check(CLI::Range(1u, 1u << 31));
  command->add_flag("--json", words->json, "print JSON");
  command
      ->add_flag_callback(
          "--html", [words] { words->html = words->html.value_or("comparison.html"); },
          "write a page in which all are looked at side by side")
      ->trigger_on_parse();
  command->add_option("-o,--output", words->html, "the page (comparison.html)")->needs("--html");
  return [words](const CommandLine& command_line) { return run_compare(*words, command_line); };
}

}  // namespace turbid
