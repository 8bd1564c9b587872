#include "methods.h"

#include "image/film_image.h"
#include "image/metrics.h"
#include "integrator/integrators.h"
#include "render/statistics.h"

namespace turbid::experiments {
namespace {

using Settings = std::vector<std::pair<std::string, std::string>>;

std::pair<std::string, std::string> split(const std::string& text) {
  const size_t equals = text.find('=');
  if (equals == std::string::npos) throw std::runtime_error("'" + text + "' has no value");
  return {text.substr(0, equals), text.substr(equals + 1)};
}

}  // namespace

Overrides overrides(const std::vector<std::string>& definitions) {
  Overrides result;
  for (const std::string& definition : definitions) {
    const auto [name, value] = split(definition);
    result[name] = value;
  }
  return result;
}

Stage::Stage(const std::string& file, const std::vector<std::string>& definitions)
    : loaded_(load_scene(file, overrides(definitions))), scene_(std::move(loaded_.parts)) {}

std::shared_ptr<Integrator> Stage::make(const std::string& integrator) const {
  Settings settings;
  size_t comma = integrator.find(',');
  const std::string type = integrator.substr(0, comma);
  while (comma != std::string::npos) {
    const size_t next = integrator.find(',', comma + 1);
    settings.push_back(split(integrator.substr(comma + 1, next - comma - 1)));
    comma = next;
  }
  return make_integrator(replace_integrator(loaded_.integrator, type, settings).description).integrator;
}

Stage::Shot Stage::render(const std::string& text, uint32_t samples, uint64_t seed) const {
  const std::shared_ptr<Integrator> integrator = make(text);
  StopFlag stop;
  integrator->prepare(scene_, seed, stop);
  Film film(scene_.film().image_size(), integrator->layer_names());
  const double begin = process_cpu_seconds();
  integrator->render_pass(scene_, {seed, 0, samples}, film, stop);
  return {film_to_image(film, false), process_cpu_seconds() - begin, integrator->counters()};
}

Noise measure_noise(const Stage& stage, const std::string& integrator, uint32_t samples, const Image& reference,
                    int seeds) {
  std::vector<double> errors, seconds;
  for (int seed = 1; seed <= seeds; ++seed) {
    const Stage::Shot shot = stage.render(integrator, samples, static_cast<uint64_t>(seed));
    errors.push_back(
        compare_images(color_channels(shot.image, integrator), color_channels(reference, "reference")).rmse);
    seconds.push_back(shot.seconds);
  }
  const double rmse = median(errors);
  return {rmse, rmse / mean_of(reference), median(seconds)};
}

double mean_of(const Image& image) {
  double sum = 0;
  size_t count = 0;
  for (const auto& channel : color_channels(image, "image"))
    for (const float value : channel) {
      sum += static_cast<double>(value);
      ++count;
    }
  return sum / static_cast<double>(count);
}

}  // namespace turbid::experiments
