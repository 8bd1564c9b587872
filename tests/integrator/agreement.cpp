#include "integrator/agreement.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include "integrator/advice.h"
#include "integrator/camera_sample.h"

namespace turbid::testing {
namespace {

const char* const kNames[] = {"all", "order 0", "order 1", "order 2", "order 3+"};

IntegratorReplacement replacement(const IntegratorDescription& old, const std::string& words) {
  std::vector<std::pair<std::string, std::string>> settings;
  const size_t comma = words.find(',');
  for (size_t at = comma; at != std::string::npos;) {
    const size_t next = words.find(',', at + 1), equals = words.find('=', at);
    settings.emplace_back(words.substr(at + 1, equals - at - 1), words.substr(equals + 1, next - equals - 1));
    at = next;
  }
  return replace_integrator(old, words.substr(0, comma), settings);
}

bool is_specular(const Bsdf& bsdf) { return !(bsdf.flags() & lobe::kSmooth) && bsdf.flags() != lobe::kNone; }

/// Does a ray through the film meet a specular surface before anything else but what it passes straight through?
bool looks_at_specular(const Scene& scene, const SensorRay& camera) {
  Ray ray = camera.ray;
  while (const Hit hit = scene.rays().intersect(ray)) {
    const Object& object = scene.object(hit);
    const bool only_null = object.bsdf->flags() == (lobe::kNull | lobe::kDelta | lobe::kTransmission);
    if (!only_null) return is_specular(*object.bsdf);
    ray = {object.shape->surface_point(ray, hit).leave(ray.direction), ray.direction};
  }
  return false;
}

std::vector<bool> find_specular_blocks(const Scene& scene, int block) {
  const Vec2i size = scene.film().image_size();
  const int columns = (size.x + block - 1) / block, rows = (size.y + block - 1) / block;
  std::vector<bool> blocks(static_cast<size_t>(columns * rows));
  Sampler sampler(SamplerKind::kIndependent, 77);
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x)
      for (uint64_t i = 0; i < 32; ++i)
        if (looks_at_specular(scene, start_camera_sample(scene, Vec2i(x, y) + scene.film().crop_offset, i, sampler)))
          blocks[static_cast<size_t>(y / block * columns + x / block)] = true;
  return blocks;
}

/// Cuts out of the support what the scene does not ask for, so that two supports differ only where it matters.
PathSupport support_in(const Scene& scene, const PathSupport& support) {
  const PathSupport asked = asked_for(scene);
  return {.specular_at_sensor = support.specular_at_sensor,
          .specular_at_delta_light = support.specular_at_delta_light || !asked.specular_at_delta_light,
          .specular_at_both_ends = support.specular_at_both_ends || !asked.specular_at_both_ends,
          .beams = support.beams || !asked.beams,
          .glowing_media = support.glowing_media || !asked.glowing_media};
}

std::string difference(const PathSupport& a, const PathSupport& b) {
  std::string text;
  const auto note = [&](bool first, bool second, const char* what) {
    if (first != second) text += std::string(text.empty() ? "cannot sample " : ", ") + what;
  };
  note(a.specular_at_delta_light, b.specular_at_delta_light, "delta lights through specular surfaces");
  note(a.beams, b.beams, "beams");
  note(a.glowing_media, b.glowing_media, "glowing media");
  return text;
}

}  // namespace

IntegratorSetup make_named(const std::string& words, const LoadedScene& loaded) {
  return make_integrator(replacement(loaded.integrator, words).description, loaded.document.get());
}

Film render_samples(const std::string& xml, const std::string& integrator, uint32_t count, int threads,
                    uint32_t first) {
  LoadedScene loaded = load_scene_from_string(xml, "test scene", {});
  const IntegratorSetup setup = make_named(integrator, loaded);
  const Scene scene(std::move(loaded.parts));
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<size_t>(threads));
  tbb::task_arena arena(threads);
  return arena.execute([&] {
    constexpr uint64_t kSeed = 1;
    StopFlag stop;
    setup.integrator->prepare(scene, kSeed, stop);
    Film film(scene.film().image_size(), setup.integrator->layer_names());
    setup.integrator->render_pass(scene, {kSeed, first, count}, film, stop);
    return film;
  });
}

void expect_same(const Film& a, const Film& b) {
  for (size_t i = 0; i < a.pixel_count(); ++i)
    for (int c = 0; c < kChannels; ++c) EXPECT_EQ(a.pixel(i).radiance[c], b.pixel(i).radiance[c]) << i;
}

Observation observe(const std::string& xml, const Contestant& contestant, int block) {
  LoadedScene loaded = load_scene_from_string(xml, "test scene", {});
  const IntegratorSetup setup = make_named(contestant.integrator, loaded);
  return observe(Scene(std::move(loaded.parts)), *setup.integrator, contestant, block);
}

Observation observe(const Scene& scene, Integrator& integrator, const Contestant& contestant, int block) {
  std::vector<std::string> names = integrator.layer_names();
  std::vector<OrderLayer> layers;
  for (int order = 0; order < kOrderClasses; ++order) {
    layers.push_back({order, order, names.size()});
    for (const char* channel : {".R", ".G", ".B"}) names.push_back("order" + std::to_string(order) + channel);
  }
  EXPECT_TRUE(integrator.split_orders(layers)) << contestant.integrator;

  StopFlag stop;
  integrator.prepare(scene, contestant.seed, stop);
  const Vec2i size = scene.film().image_size();
  const PassStatistics none(size, block);
  Observation result{
      none, {none, none, none, none}, find_specular_blocks(scene, block), support_in(scene, integrator.support())};
  for (uint32_t pass = 0; pass < kPasses; ++pass) {
    Film film(size, names);
    integrator.render_pass(scene, {contestant.seed, uint64_t{pass} * contestant.samples, contestant.samples}, film,
                           stop);
    for (PixelSums& pixel : film.pixels())
      for (double& value : pixel.radiance) value *= contestant.brightness;
    result.all.add(film);
    for (const OrderLayer& layer : layers) {
      Film part(size);
      part.add_samples(film.samples());
      for (size_t i = 0; i < film.pixel_count(); ++i)
        for (size_t c = 0; c < kChannels; ++c)
          part.pixel(i).radiance[c] = film.layers(i)[layer.channel + c] * contestant.brightness;
      result.orders[static_cast<size_t>(layer.min_order)].add(part);
    }
  }
  Counters counters = integrator.counters();
  EXPECT_EQ(counters["dropped_samples"], 0u) << contestant.integrator;
  EXPECT_EQ(counters["saturated_splats"], 0u) << contestant.integrator;
  return result;
}

Agreement compare(const Observation& first, const Observation& second) {
  Agreement result;
  result.cannot = difference(first.support, second.support);
  if (!result.cannot.empty()) return result;
  std::vector<bool> skip(first.specular_blocks.size());
  if (first.support.specular_at_sensor != second.support.specular_at_sensor ||
      first.support.specular_at_both_ends != second.support.specular_at_both_ends)
    skip = first.specular_blocks;
  result.blocks = static_cast<size_t>(std::count(skip.begin(), skip.end(), false));
  if (result.blocks == 0) {
    result.cannot = "cannot sample what the sensor sees in specular surfaces";
    return result;
  }
  for (size_t k = 0; k <= kOrderClasses; ++k) {
    const PassStatistics& a = k == 0 ? first.all : first.orders[k - 1];
    const PassStatistics& b = k == 0 ? second.all : second.orders[k - 1];
    double sum_a = 0, sum_b = 0, variance_a = 0, variance_b = 0;
    for (size_t block = 0; block < a.block_count(); ++block) {
      if (skip[block]) continue;
      for (int c = 0; c < kChannels; ++c) {
        sum_a += a.mean(block, c);
        sum_b += b.mean(block, c);
      }
      // The channels of one block may be fully correlated.
      const auto of_sum = [&](const PassStatistics& s) {
        return sqr(std::sqrt(s.variance(block, 0)) + std::sqrt(s.variance(block, 1)) + std::sqrt(s.variance(block, 2)));
      };
      variance_a += of_sum(a) / kPasses;
      variance_b += of_sum(b) / kPasses;
    }
    if (sum_a == 0 && sum_b == 0) continue;
    result.verdicts[k] = two_estimator_z_test(a, b, skip);
    result.mean_ratio[k] = sum_b / sum_a;
    result.ratio_error[k] = result.mean_ratio[k] * std::sqrt(variance_a / sqr(sum_a) + variance_b / sqr(sum_b));
  }
  return result;
}

double Agreement::smallest_p_of_means() const {
  double result = 1;
  for (size_t k = 0; k < verdicts.size(); ++k) {
    if (!verdicts[k]) continue;
    // No error: one of the two saw nothing.
    const double p = ratio_error[k] > 0 ? std::erfc(std::abs(mean_ratio[k] - 1) / ratio_error[k] / std::numbers::sqrt2)
                                        : (mean_ratio[k] == 1 ? 1 : 0);
    result = std::min(result, p);
  }
  return result;
}

double Agreement::smallest_p() const {
  double result = smallest_p_of_means();
  for (const auto& verdict : verdicts)
    if (verdict) result = std::min(result, verdict->smallest_p);
  return result;
}

bool Agreement::accepted(double p, bool with_blocks, size_t comparisons) const {
  size_t tests = 0;
  for (const auto& verdict : verdicts)
    if (verdict) tests += (with_blocks ? verdict->tests : 0) + 1;
  const auto all = static_cast<double>(std::max<size_t>(tests * comparisons, 1));
  return p > -std::expm1(std::log1p(-ZTestResult::kSignificance) / all);
}

std::string Agreement::report() const {
  if (!cannot.empty()) return cannot;
  std::string text;
  for (size_t k = 0; k < verdicts.size(); ++k)
    if (verdicts[k])
      text += fmt::format("{:<9} ratio {:.5f} +- {:.5f}, {:5.1f} % pass, worst |z| {:.2f} in block {}, p {:.2g}\n",
                          kNames[k], mean_ratio[k], ratio_error[k], 100 * verdicts[k]->pass_fraction(),
                          verdicts[k]->worst_z, verdicts[k]->worst_index, verdicts[k]->smallest_p);
  return text;
}

void expect_agreement(const std::string& xml, const Contestant& first, const Contestant& second, double largest_error,
                      int block) {
  const Agreement agreement = compare(observe(xml, first, block), observe(xml, second, block));
  EXPECT_EQ(agreement.cannot, "");
  EXPECT_TRUE(agreement.accepted()) << agreement.report();
  EXPECT_LT(agreement.ratio_error[0], largest_error) << "too noisy to say anything";
}

}  // namespace turbid::testing
