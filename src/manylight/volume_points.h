#pragma once
#include "medium/homogeneous.h"
#include "path/events.h"
#include "path/passage.h"

namespace turbid {

/// A distance and its density, 1/length.
struct MadeDistance {
  float t, pdf_t;
};

/// The distance of a collision before `length`, given that there is one: density of the mixture of the channels,
/// sum mix_i sigma_i T_i(t) / (1 - T_i(length)). Takes one number. Evenly where no channel collides.
MadeDistance collide_before(const HomogeneousMedium& medium, float length, const Spectrum& mix, float u);

/// How collisions on a way from the sensor are made.
struct VolumePoints {
  int count = 4;                 ///< on each way through a medium
  bool by_transmittance = true;  ///< else evenly (S2 eq. 7, but at random within the pieces)
};

/// Makes collisions on `way`, which passes through the medium, and calls shade(event, state) for each: the state
/// holds the path up to the collision, its throughput transmittance x sigma_s / density. Stratified; takes points.count
/// numbers. None where paths would get longer than max_depth edges.
template <class Shade>
void make_collisions(const Ray& way, const Medium& medium, const PathState& state, int max_depth,
                     const VolumePoints& points, Sampler& sampler, const Shade& shade) {
  const HomogeneousMedium* homogeneous = medium.as_homogeneous();
  const Spectrum mix = channel_mix(state.throughput);
  for (int i = 0; i < points.count; ++i) {
    const float u = (static_cast<float>(i) + sampler.next_1d()) / static_cast<float>(points.count);
    if (state.depth + 1 >= max_depth || !(way.t_max > 0) || state.throughput.is_black()) continue;
    const auto distance = homogeneous && points.by_transmittance ? collide_before(*homogeneous, way.t_max, mix, u)
                                                                 : MadeDistance{way.t_max * u, 1 / way.t_max};
    if (!std::isfinite(distance.t) || !(distance.pdf_t > 0)) continue;
    const Vec3 p = way.at(distance.t);
    const Spectrum arrives = homogeneous ? homogeneous->transmittance(distance.t)
                                         : medium.transmittance({way.origin, way.direction, distance.t}, sampler);
    const Spectrum factor = arrives * medium.sigma_s_at(p) / (distance.pdf_t * static_cast<float>(points.count));
    if (factor.is_black()) continue;
    shade(CollisionEvent{p, way.direction, medium},
          PathState{state.throughput * factor, state.depth + 1, state.order + 1, state.visit_order + 1});
  }
}

}  // namespace turbid
