#include "render/output.h"

#include <fmt/format.h>

#include <filesystem>

#include "image/atomic_file.h"
#include "image/film_image.h"
#include "image/image_file.h"
#include "image/outlier_rejection.h"
#include "render/pass_plan.h"

namespace turbid {
namespace {

/// The image's path with its extension replaced.
std::string beside(const std::string& path, const std::string& ending) {
  const std::filesystem::path p(path);
  return (p.parent_path() / (p.stem().string() + ending)).string();
}

void describe_image(Image& image, const OutputSettings& settings, const Film& film, double seconds) {
  image.offset = settings.crop_offset;
  image.full_size = settings.film_size;
  image.metadata = settings.metadata;
  const uint64_t per_pass = samples_per_pass(film.size());
  image.metadata["samples"] = std::to_string(film.samples());
  if (settings.tells_passes) image.metadata["passes"] = std::to_string((film.samples() + per_pass - 1) / per_pass);
  image.metadata["seconds"] = fmt::format("{:.3f}", seconds);
}

std::string describe_rejection(const OutlierSettings& settings, const Image& image) {
  return fmt::format(
      "reweight start={:.6g} base={:.6g} kappa={:.6g}: takes {:.5f} of the light; the mean is in unweighted.*",
      settings.start, settings.base, settings.kappa, rejected_share(image));
}

}  // namespace

std::string OutputSettings::png_path() const { return beside(path, ".png"); }
std::string OutputSettings::variance_path() const { return beside(path, "_var.exr"); }
std::string OutputSettings::checkpoint_path() const { return beside(path, ".ckpt"); }

std::vector<std::string> write_output(const OutputSettings& settings, const Film& film, double seconds) {
  std::vector<std::string> written;
  if (settings.path.empty()) return written;
  Image image = film_to_image(film, settings.alpha);
  if (settings.outliers) image = reject_outliers(image, film, *settings.outliers);
  describe_image(image, settings, film, seconds);
  if (settings.outliers) image.metadata["outlier_rejection"] = describe_rejection(*settings.outliers, image);
  const Image layered = with_layers(image, film);
  if (settings.moment_name.empty())
    write_exr(settings.path, layered);
  else
    write_exr(settings.path, with_moment_layers(layered, film, settings.moment_name));
  written.push_back(settings.path);
  if (settings.variance) {
    Image variance = variance_image(film);
    describe_image(variance, settings, film, seconds);
    variance.metadata["content"] = "variance of one sample, CIE XYZ mapped to RGB";
    write_exr(settings.variance_path(), variance);
    written.push_back(settings.variance_path());
  }
  if (settings.png) {
    write_png(settings.png_path(), image, settings.exposure);
    written.push_back(settings.png_path());
  }
  return written;
}

void check_output(const OutputSettings& settings) {
  if (settings.path.empty()) return;
  check_writable(settings.path);
  if (settings.png) check_writable(settings.png_path());
  if (settings.variance) check_writable(settings.variance_path());
  check_writable(settings.checkpoint_path());
}

}  // namespace turbid
