#pragma once
#include <memory>
#include <mutex>

#include "image/splat_buffer.h"
#include "integrator/integrator.h"
#include "path/contribution.h"
#include "path/sample_counters.h"

namespace turbid {

/// An integrator whose light paths may reach any pixel. For each sample index there is one light path for every pixel
/// of the film; the picture that they make together, with what the pixels gather themselves, is one sample of every
/// pixel: means, variances and passes mean what they mean elsewhere. Sample n of pixel i is named by (seed, n, i);
/// splats are summed in fixed point: the same bits for any number of threads.
class SplattingIntegrator : public Integrator {
 public:
  /// Finds the scale of the fixed-point sums by a pilot of some thousand paths.
  void prepare(const Scene& scene, uint64_t seed, const StopFlag& stop) override;
  bool render_pass(const Scene& scene, const Pass& pass, Film& film, const StopFlag& stop) override;
  Counters counters() const override;
  bool split_orders(const std::vector<OrderLayer>& layers) override;
  std::vector<std::string> layer_names() const override;

  /// Makes samples, one after the other; used by one thread.
  class Worker {
   public:
    virtual ~Worker() = default;
    /// Sample `index` of pixel `pixel` of the crop window. Returns the sample's alpha.
    virtual float run(size_t pixel, uint64_t index, ContributionSink& sink) = 0;
  };

 protected:
  virtual std::unique_ptr<Worker> make_worker(const Scene& scene, uint64_t seed, SampleCounters& counters) const = 0;
  /// Once, before any worker: what all of them share.
  virtual void prepare_workers(const Scene& scene) = 0;
  /// Before the workers make sample `index` of all pixels: what they share for this sample alone, such as what walks
  /// from the sensor have left for light to find. False: it does not fit into memory at once; the workers run, without
  /// gathering, and then the next round is prepared. They gather in the last round.
  virtual bool prepare_round(const Scene& /*scene*/, uint64_t /*seed*/, uint64_t /*index*/, int /*round*/,
                             const StopFlag& /*stop*/) {
    return true;
  }

  /// False: the workers only gather, so that splats need no scale.
  virtual bool splats() const { return true; }

  /// Writes the contributions of all strategies for paths of up to `max_edges` edges into layers of their own, named
  /// strategy.{weighted,plain}.EDGES.LIGHT_VERTICES.{R,G,B}.
  void show_strategies(int max_edges) { shown_edges_ = max_edges; }
  /// Writes what each Technique contributes into layers of its own, named technique.NAME.{R,G,B}.
  void show_techniques() { shows_techniques_ = true; }

  /// Counts what happened outside of workers, too: from any thread.
  void add_counters(const SampleCounters& counters);

 private:
  class PilotSink;
  class PassSink;
  struct Splats;
  /// Layer triple of a strategy, weighted; the plain one follows. Negative: not shown.
  int strategy_layer(int light_vertices, int edges) const;
  /// The first channel of a technique; behind all strategies.
  size_t technique_channel(Technique technique) const;

  std::vector<OrderLayer> order_layers_;
  int shown_edges_ = 0;
  bool shows_techniques_ = false;
  int largest_exponent_ = 0;  ///< of the splats of the pilot: they are below 2^largest_exponent
  mutable std::mutex mutex_;
  SampleCounters totals_;
  uint64_t saturated_ = 0;
};

/// Keeps the random streams of light paths apart from those of pixels.
inline constexpr uint64_t kLightStream = 0x6c69676874ull;

}  // namespace turbid
