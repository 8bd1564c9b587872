#include "experiment/reference.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "core/cache_folder.h"
#include "core/hash.h"
#include "core/version.h"
#include "image/atomic_file.h"
#include "image/film_image.h"
#include "image/image_file.h"
#include "render/checkpoint.h"
#include "render/render_job.h"
#include "render/threads.h"

namespace turbid {
namespace {

namespace fs = std::filesystem;

/// Seeds of the halves: methods count theirs from 1.
constexpr uint64_t kSeeds[2] = {1'000'001, 1'000'002};

/// Unlike scene_fingerprint it does not hash the commit.
uint64_t hash_of(const StagedScene& staged) {
  const SceneChoice& choice = staged.choice();
  uint64_t hash = 0;
  const auto add = [&](std::string_view text) { hash = hash_bytes(text, hash); };
  add(version());
  for (const fs::path& file : staged.files())
    if (fs::exists(file)) add(read_file(file.string()));
  for (const std::string& definition : choice.definitions) add(definition);
  add(choice.integrator);
  add(choice.size);
  return hash;
}

struct Half {
  Film film;
  double wall = 0;
  bool is_new = false;
};

/// What a checkpoint holds, if it is one of this render.
std::optional<Checkpoint> stored_half(const std::string& path, uint64_t fingerprint) {
  if (!fs::exists(path)) return {};
  try {
    Checkpoint checkpoint = read_checkpoint(path);
    if (checkpoint.fingerprint == fingerprint && checkpoint.film.samples() > 0) return checkpoint;
  } catch (const FileError&) {
    // Damaged: rendered again.
  }
  fs::remove(path);
  return {};
}

/// `seconds` of wall time, those of earlier runs included.
Half find_half(const Scene& scene, Integrator& integrator, const RenderOptions& with, double seconds) {
  RenderOptions options = with;
  if (auto stored = stored_half(options.output.checkpoint_path(), options.fingerprint)) {
    if (stored->seconds >= 0.98 * seconds) return {std::move(stored->film), stored->seconds};
    seconds -= stored->seconds;
  }
  options.budget.seconds = seconds;
  RenderResult result = render(make_task(scene, integrator), options);
  if (result.statistics.interrupted) throw Interrupted();
  return {std::move(result.film), result.seconds, true};
}

/// Which turbid made the picture; empty where it does not say.
std::string version_in(const std::string& picture) {
  if (!fs::exists(picture)) return {};
  try {
    const Image image = read_exr(picture);
    const auto found = image.metadata.find("version");
    return found == image.metadata.end() ? "" : found->second;
  } catch (const FileError&) {
    return {};
  }
}

/// Mean over pixels and channels of the variance between samples, over their number.
double variance_of_mean(const Film& film) {
  const auto n = static_cast<double>(film.samples());
  if (n < 2) return 0;
  double sum = 0;
  for (const PixelSums& pixel : film.pixels())
    for (int c = 0; c < kChannels; ++c) {
      const double mean = pixel.radiance[c] / n;
      sum += std::max(0.0, pixel.squares[c] / n - mean * mean) / (n - 1);
    }
  return sum / static_cast<double>(film.pixel_count() * kChannels);
}

}  // namespace

Reference reference_of(const Film& a, const Film& b) {
  Film both = a;
  both.add(b);
  Reference reference;
  reference.image = film_to_image(both, false);
  reference.samples = both.samples();
  const auto n = static_cast<double>(a.samples()), m = static_cast<double>(b.samples());
  const double weight = n * m / ((n + m) * (n + m));
  double sum = 0, squares = 0, relative = 0, light = 0;
  std::vector<float> values;
  for (size_t i = 0; i < both.pixel_count(); ++i) {
    double pixel = 0;  // channels of a pixel are not independent
    for (int c = 0; c < kChannels; ++c) {
      const double d = a.pixel(i).radiance[c] / n - b.pixel(i).radiance[c] / m;
      const double mean = both.pixel(i).radiance[c] / (n + m);
      pixel += weight * d * d / kChannels;
      relative += weight * d * d / (mean * mean + kRelMseFloor) / kChannels;
      light += mean / kChannels;
      values.push_back(static_cast<float>(mean));
    }
    sum += pixel;
    squares += pixel * pixel;
  }
  const auto count = static_cast<double>(both.pixel_count());
  const double mse = sum / count;
  reference.error.mse = {mse, std::sqrt(std::max(0.0, squares / count - mse * mse) / count)};
  reference.error.rel_mse = relative / count;
  reference.error.mean = light / count;
  reference.error.peak = percentile(std::move(values), 0.99);
  const double by_a = variance_of_mean(a) * n * n, by_b = variance_of_mean(b) * m * m;
  reference.error.by_variance = (by_a + by_b) / ((n + m) * (n + m));
  return reference;
}

Reference find_reference(const StagedScene& staged, const ReferenceRequest& request) {
  const uint64_t hash = hash_of(staged);
  make_folder(request.folder);
  const std::string key = fmt::format("{}-{:016x}", fs::path(staged.choice().file).stem().string(), hash);

  const auto picture_path = [&](int half) { return fmt::format("{}/{}-{}.exr", request.folder, key, half); };
  Half halves[2];
  for (int i = 0; i < 2; ++i) {
    RenderOptions options;
    options.seed = kSeeds[i];
    options.fingerprint = hash_bytes(std::string_view("half"), hash + options.seed);
    options.resume = true;
    options.quiet = true;
    options.growing_passes = true;
    options.save_seconds = 15;
    options.output.path = picture_path(i + 1);
    options.output.png = false;
    options.output.metadata = {{"scene", staged.choice().name()},
                               {"integrator", staged.describe()},
                               {"version", fmt::format("turbid {} {}", version(), version_commit())},
                               {"seed", std::to_string(options.seed)}};
    if (request.anew) fs::remove(options.output.checkpoint_path());
    const IntegratorSetup setup = staged.make();
    halves[i] = find_half(staged.scene(), *setup.integrator, options, request.seconds / 2 / thread_count());
  }
  Reference reference = reference_of(halves[0].film, halves[1].film);
  reference.key = key;
  reference.version = version_in(picture_path(2));
  reference.wall = halves[0].wall + halves[1].wall;
  reference.is_new = halves[0].is_new || halves[1].is_new;
  return reference;
}

}  // namespace turbid
