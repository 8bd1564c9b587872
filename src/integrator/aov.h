#pragma once
#include "integrator/features.h"
#include "integrator/integrator_plugin.h"

namespace turbid {

/// One layer of the `aov` integrator: what it shows, and where in the film's layers its channels begin.
struct AovLayer {
  std::string type;  ///< "albedo", "depth" ...
  size_t channel;
};

/// Writes layers beside the picture of another integrator: what every sensor ray comes to first (see Features), as
/// denoisers want it, and the light of single scattering orders. The picture is bit for bit what it is without layers.
class AovIntegrator : public Integrator {
 public:
  /// `inner` may be null: the picture is black then.
  AovIntegrator(std::shared_ptr<Integrator> inner, std::vector<AovLayer> layers, std::vector<std::string> names)
      : inner_(std::move(inner)), layers_(std::move(layers)), names_(std::move(names)) {}

  void prepare(const Scene& scene, uint64_t seed, const StopFlag& stop) override;
  bool render_pass(const Scene& scene, const Pass& pass, Film& film, const StopFlag& stop) override;
  std::vector<std::string> layer_names() const override { return names_; }
  bool sees_media() const override { return !inner_ || inner_->sees_media(); }
  PathSupport support() const override { return inner_ ? inner_->support() : PathSupport{}; }
  Counters counters() const override { return inner_ ? inner_->counters() : Counters{}; }

 private:
  void add_features(const Scene& scene, const Pass& pass, int row, Film& film) const;

  std::shared_ptr<Integrator> inner_;
  std::vector<AovLayer> layers_;
  std::vector<std::string> names_;
};

/// The row of the integrator table.
IntegratorPlugin aov_row();

}  // namespace turbid
