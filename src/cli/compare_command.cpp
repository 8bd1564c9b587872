#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.h"
#include "core/error.h"
#include "image/image_file.h"
#include "image/z_test.h"

namespace turbid {
namespace {

/// The words after `turbid compare`.
struct CompareWords {
  std::string image, reference, variance;
  std::optional<uint64_t> spp;
  bool json = false;
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

/// Samples per pixel of the image, as given or as its metadata say.
uint64_t samples_of(const CompareWords& words, const Image& image) {
  if (words.spp) return *words.spp;
  const auto found = image.metadata.find("samples");
  uint64_t samples = 0;
  if (found != image.metadata.end())
    std::from_chars(found->second.data(), found->second.data() + found->second.size(), samples);
  if (samples == 0)
    throw UsageError("--variance needs --spp: " + words.image + " does not say how many samples a pixel has");
  return samples;
}

void print_text(const ImageMetrics& m, const ZTestResult* z, uint64_t spp, int width) {
  fmt::print("RMSE        {:.6g}\nPSNR        {:.4g} dB (peak {:.6g})\nrelMSE      {:.6g}\nMAE         {:.6g}\n",
             m.rmse, m.psnr, m.peak, m.rel_mse, m.mae);
  fmt::print("mean ratio  {:.6g} ({:.6g})\n", m.mean_ratio, fmt::join(m.channel_mean_ratios, ", "));
  if (m.non_finite > 0) fmt::print("not finite  {} values, left out\n", m.non_finite);
  if (!z) return;
  const auto x = z->worst_index % static_cast<size_t>(width), y = z->worst_index / static_cast<size_t>(width);
  fmt::print(
      "z-test      {}: {:.3f} % of the tests pass ({:.2f} % needed), {} samples per pixel, worst |z| {:.3g} at pixel "
      "({}, {})\n",
      z->accepted() ? "accepted" : "REJECTED", 100 * z->pass_fraction(), 100 * ZTestResult::kAcceptedFraction, spp,
      z->worst_z, x, y);
}

void print_json(const ImageMetrics& m, const ZTestResult* z, uint64_t spp, int width) {
  nlohmann::ordered_json json = {{"rmse", m.rmse},
                                 {"psnr", m.psnr},
                                 {"peak", m.peak},
                                 {"rel_mse", m.rel_mse},
                                 {"mae", m.mae},
                                 {"mean_ratio", m.mean_ratio},
                                 {"channel_mean_ratios", m.channel_mean_ratios},
                                 {"non_finite", m.non_finite}};
  if (z) {
    json["z_test"] = {
        {"accepted", z->accepted()},
        {"pass_fraction", z->pass_fraction()},
        {"samples_per_pixel", spp},
        {"level", z->level},
        {"smallest_p", z->smallest_p},
        {"worst_z", z->worst_z},
        {"worst_pixel", {z->worst_index % static_cast<size_t>(width), z->worst_index / static_cast<size_t>(width)}}};
  }
  fmt::print("{}\n", json.dump(2));
}

int run_compare(const CompareWords& words) {
  if (words.spp && words.variance.empty()) throw UsageError("--spp means something only with --variance");
  const Image image = read_image(words.image), reference = read_image(words.reference);
  require_same_size(image, words.image, reference, words.reference);
  const ChannelList a = color_channels(image, words.image), b = color_channels(reference, words.reference);
  const ImageMetrics metrics = compare_images(a, b);
  std::optional<ZTestResult> verdict;
  uint64_t spp = 0;
  if (!words.variance.empty()) {
    const Image variance = read_image(words.variance);
    require_same_size(variance, words.variance, reference, words.reference);
    spp = samples_of(words, image);
    verdict = z_test(to_xyz(a), spp, to_xyz(b), read_variance(variance, words.variance));
  }
  (words.json ? print_json : print_text)(metrics, verdict ? &*verdict : nullptr, spp, image.width());
  return kExitDone;
}

}  // namespace

Command add_compare_command(CLI::App& app) {
  auto words = std::make_shared<CompareWords>();
  CLI::App* command = app.add_subcommand("compare", "say how far an image is from a reference");
  command->add_option("IMAGE", words->image, "the image to judge")->required();
  command->add_option("REFERENCE", words->reference, "what it should be")->required();
  command->add_option("--variance", words->variance,
                      "variance of one sample, for a z-test per pixel: a *_var.exr, or an image with layers m2_*");
  command->add_option("--spp", words->spp, "samples per pixel of IMAGE, when it does not say")
      ->check(CLI::Range(1u, 1u << 31));
  command->add_flag("--json", words->json, "print JSON");
  return [words](const CommandLine&) { return run_compare(*words); };
}

}  // namespace turbid
