#pragma once
#include "manylight/scatterer.h"
#include "manylight/segment_pair.h"
#include "medium/homogeneous.h"
#include "path/passage.h"

namespace turbid {

/// A way through a medium on which a walk could collide anywhere: of a light path a virtual ray light (Novak et al.
/// 2012), of a walk from the sensor a way that is shaded. place_at() makes a collision at one place of it.
class CollisionSegment {
 public:
  /// A way of the sensor's walk: `state` holds the path up to its beginning.
  static CollisionSegment of_sensor(const Ray& way, const Medium& medium, const PathState& state);
  /// What a light path flew before it collided or passed, `way` of finite length; `state` at its beginning, `scale` a
  /// factor of its flux. Only in homogeneous media, whose flights have densities in closed form.
  static CollisionSegment of_light(const Ray& way, const HomogeneousMedium& medium, const PathState& state,
                                   float scale);

  const Ray& way() const { return way_; }
  const Medium& medium() const { return *medium_; }
  /// Mean cosine of the phase function; for densities.
  float g() const { return g_; }
  int depth() const { return depth_; }  ///< of a collision on it
  int order() const { return order_; }
  int visit_order() const { return visit_order_; }  ///< PathState::visit_order

  /// A collision at distance t, with what the walk brings to it per length; times 1 / (density of t).
  /// From a light: flux x sigma_s x T_i(t) / sum mix_j T_j(t), for the segment ends at t or before with the rest of the
  /// probability. From the sensor: throughput x T(t) x sigma_s. `sampler`: for media that vary.
  Scatterer place_at(float t, double pdf_t, const Sampler& sampler) const {
    const CollisionEvent event{way_.at(t), way_.direction, *medium_};
    const auto density = static_cast<float>(1 / pdf_t);
    return Scatterer(event, PathState{homogeneous_ ? scattered_ * arriving(homogeneous_->transmittance(t)) * density
                                                   : scattered_at(event.position, t, sampler) * density,
                                      depth_, order_, visit_order_});
  }

 private:
  CollisionSegment() = default;

  Spectrum arriving(const Spectrum& transmittance) const {
    if (!from_light_) return transmittance;
    const float survives = (mix_ * transmittance).sum();
    return survives > 0 ? transmittance / survives : Spectrum(0.0f);
  }
  /// The same where the medium varies.
  Spectrum scattered_at(const Vec3& p, float t, const Sampler& sampler) const;

  Ray way_;
  const Medium* medium_ = nullptr;
  const HomogeneousMedium* homogeneous_ = nullptr;
  Spectrum throughput_, mix_;
  Spectrum scattered_;  ///< throughput x sigma_s, where the medium is homogeneous
  float g_ = 0;
  int depth_ = 0, order_ = 0, visit_order_ = 0;
  bool from_light_ = false;
};

}  // namespace turbid
