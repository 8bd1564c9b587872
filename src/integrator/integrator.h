#pragma once
#include <atomic>
#include <map>
#include <string>

#include "image/film.h"
#include "scene/scene.h"

namespace turbid {

/// What a pass may depend on, and nothing else: the seed and its place in the sequence of samples.
struct Pass {
  uint64_t seed = 0;
  uint64_t first_sample = 0;  ///< of every pixel
  uint32_t sample_count = 1;  ///< per pixel
};

/// Told by the render job when a pass should be abandoned: the user interrupts, the time is up. Looked at often.
class StopFlag {
 public:
  void request() { stop_.store(true, std::memory_order_relaxed); }
  bool requested() const { return stop_.load(std::memory_order_relaxed); }

 private:
  std::atomic<bool> stop_{false};
};

/// The light of scattering orders [min_order, max_order] goes to three channels of the film's layers, from `channel`
/// on.
struct OrderLayer {
  int min_order, max_order;  ///< below kOrderClasses, whose last one stands for all higher orders too
  size_t channel;
};

/// Which kinds of paths an integrator finds; a comparison of two covers what both do (NUMERICS 10). A delta light is
/// one that nothing meets by chance, a specular vertex one that leaves no choice of direction; passing straight on is
/// no vertex.
struct PathSupport {
  bool specular_at_sensor = true;        ///< the vertex next to the sensor is specular
  bool specular_at_delta_light = false;  ///< a delta light shines on a specular vertex
  /// Both, with a single vertex between them that is not specular: no line joins it with anything.
  bool specular_at_both_ends = false;
  bool beams = false;  ///< the light of emitters that cannot be aimed at
  bool glowing_media = true;
};

/// Counters that integrators keep while rendering, summed over threads: rays cast, samples dropped ... by name.
using Counters = std::map<std::string, uint64_t>;

/// An image-level algorithm. A render is a sum of independent passes; each is a whole image that depends only on its
/// Pass.
class Integrator {
 public:
  virtual ~Integrator() = default;

  /// Once, before the first pass: tables, caches, pilots. Must depend on scene and seed alone.
  virtual void prepare(const Scene& /*scene*/, uint64_t /*seed*/, const StopFlag& /*stop*/) {}

  /// Adds one pass to `film` (cleared, of the scene's crop size). Returns false when stopped half-way: the caller then
  /// throws the film away.
  virtual bool render_pass(const Scene& scene, const Pass& pass, Film& film, const StopFlag& stop) = 0;

  /// Names of the channels that render_pass adds to the film's layers.
  virtual std::vector<std::string> layer_names() const { return {}; }
  /// Asks for the light of some scattering orders in layers of their own, which others name. False: it cannot tell.
  virtual bool split_orders(const std::vector<OrderLayer>& /*layers*/) { return false; }
  /// False: media are ignored.
  virtual bool sees_media() const { return true; }

  virtual PathSupport support() const { return {}; }

  /// Counters since construction.
  virtual Counters counters() const { return {}; }
};

}  // namespace turbid
