#include "photon/photon_gatherer.h"

namespace turbid {
namespace {

double disk(float radius) { return static_cast<double>(kPi * sqr(radius)); }
double ball(float radius) { return static_cast<double>(4.0f / 3 * kPi * sqr(radius) * radius); }

}  // namespace

Merging merging_by(const KernelRadii& radii, const PhotonCounts& counts) {
  return {.surface = counts.paths * disk(radii.surface),
          .point_point = counts.paths * ball(radii.point_point),
          .point_beam = counts.paths * disk(radii.point_beam),
          .beam_point = counts.beam_paths * disk(radii.beam_point),
          .beam_beam = counts.beam_paths * 2 * static_cast<double>(radii.beam_beam),
          .inhomogeneous = counts.paths * ball(radii.inhomogeneous),
          .dense_from = static_cast<double>(radii.dense_from)};
}

void PhotonGatherer::at(const Vertex& vertex, ContributionSink& sink, MergeWork& work) const {
  if (vertex.is_surface()) {
    if (radii_.surface > 0 && (vertex.object->bsdf->flags() & lobe::kSmooth)) at_surface(vertex, sink, work);
    return;
  }
  points_at(vertex, sink, work);
  if (radii_.beam_point > 0) beams_at(vertex, sink, work);
}

/// The flux that arrives around a point, over the area, scattered as there: F f |cos_s| / (|cos_g| pi R^2), where cos_s
/// is what scattering is defined with and cos_g what turns flux into irradiance.
void PhotonGatherer::at_surface(const Vertex& vertex, ContributionSink& sink, MergeWork& work) const {
  const float scale = static_cast<float>(1 / (counts_.paths * disk(radii_.surface)));
  ++work.counters.point_queries;
  map_.surfaces().around(vertex.position, radii_.surface, [&](uint32_t number) {
    ++work.counters.point_tests;
    const PhotonPoint& photon = map_.photons.surfaces[number];
    const int order = vertex.order + photon.order;
    if (!(length_squared(photon.position - vertex.position) < sqr(radii_.surface))) return;
    if (dot(photon.ng, vertex.point.ng) < kSameSurface || !counts(vertex.depth + photon.depth, order, photon.bent))
      return;
    const Vec3 wi = -photon.direction;
    if (vertex.medium && !path_.visit_counts(vertex.medium, vertex.visit_order_towards(wi) + photon.visit_order))
      return;
    const Vertex::Scattering scattered = vertex.scatter(wi, TransportMode::kRadiance);
    if (scattered.value.is_black()) return;
    const double merged = weights_.merged_at_surface();
    const double beside = photon.beside_merge(weights_, static_cast<double>(scattered.pdf_w)) +
                          weights_.beside_merge(vertex.sums, static_cast<double>(scattered.pdf_back_w));
    ++work.counters.merges;
    sink.gather(
        {vertex.throughput * scattered.value * photon.flux * (scale / std::abs(dot(photon.ng, photon.direction))),
         static_cast<float>(StrategyWeights::merge_weight(merged, merged, beside)), photon.depth, vertex.depth + 1,
         order, Technique::kSurface});
  });
}

/// P-P3D. Both fluxes hold the albedo of their collision: one is taken out.
void PhotonGatherer::points_at(const Vertex& vertex, ContributionSink& sink, MergeWork& work) const {
  const Medium& medium = *vertex.medium;
  const HomogeneousMedium* homogeneous = medium.as_homogeneous();
  const float radius = homogeneous ? radius_in(*homogeneous, radii_.point_point) : radii_.inhomogeneous;
  if (!(radius > 0)) return;
  const Spectrum sigma_s = medium.sigma_s_at(vertex.position);
  Spectrum throughput;
  for (int c = 0; c < kChannels; ++c) throughput[c] = sigma_s[c] > 0 ? vertex.throughput[c] / sigma_s[c] : 0;
  throughput *= static_cast<float>(1 / (counts_.paths * ball(radius)));
  ++work.counters.point_queries;
  map_.collisions().around(vertex.position, radius, [&](uint32_t number) {
    ++work.counters.point_tests;
    const PhotonPoint& photon = map_.photons.collisions[number];
    const int order = vertex.order - 1 + photon.order;
    if (!(length_squared(photon.position - vertex.position) < sqr(radius))) return;
    if (photon.medium != &medium || !counts(vertex.depth + photon.depth, order, photon.bent)) return;
    if (!path_.visit_counts(&medium, vertex.visit_order - 1 + photon.visit_order)) return;
    const float mu = dot(photon.direction, vertex.given);
    const float f = medium.phase().eval(mu);
    const Merges merges = merges_at(weights_, medium, mu);
    const auto pdf_w = static_cast<double>(f);
    const double beside = photon.beside_merge(weights_, pdf_w) + weights_.beside_merge(vertex.sums, pdf_w);
    ++work.counters.merges;
    sink.gather({throughput * photon.flux * f,
                 static_cast<float>(StrategyWeights::merge_weight(merges.point_point, merges.sum(), beside)),
                 photon.depth, vertex.depth + 1, order, Technique::kPointPoint});
  });
}

/// B-P2D.
void PhotonGatherer::beams_at(const Vertex& vertex, ContributionSink& sink, MergeWork& work) const {
  const HomogeneousMedium* medium = vertex.medium->as_homogeneous();
  if (!medium) return;
  const float radius = radius_in(*medium, radii_.beam_point);
  const float scale = static_cast<float>(1 / (counts_.beam_paths * disk(radius)));
  work.found.clear();
  ++work.counters.beam_queries;
  map_.beams_around(vertex.position, [&](uint32_t number, float from, float to) {
    ++work.counters.beam_tests;
    const PhotonBeam& beam = map_.photons.beams[number];
    const int order = vertex.order + beam.order;
    if (beam.medium != medium || !counts(vertex.depth + beam.depth + 1, order, beam.bent)) return;
    if (!path_.visit_counts(medium, vertex.visit_order + beam.visit_order)) return;
    const float t = nearest_within(beam.ray(), vertex.position, radius);
    if (t > 0 && t >= from && t < to) work.found.push_back({number, {0, t, 0}});
  });
  work.sort();
  for (const auto& [number, crossing] : work.found) {
    const PhotonBeam& beam = map_.photons.beams[number];
    const int order = vertex.order + beam.order;
    const float t = crossing.on_second;
    const float mu = dot(beam.ray().direction, vertex.given);
    const float f = medium->phase().eval(mu);
    const Merges merges = merges_at(weights_, *medium, mu);
    const auto pdf_w = static_cast<double>(f);
    const double beside = weights_.beside_merge(map_.sums_at(scene_, weights_, beam, t), pdf_w) +
                          weights_.beside_merge(vertex.sums, pdf_w);
    ++work.counters.merges;
    sink.gather({vertex.throughput * beam.segment.flux_at(t, *medium) * (f * scale),
                 static_cast<float>(StrategyWeights::merge_weight(merges.beam_point, merges.sum(), beside)),
                 beam.depth + 1, vertex.depth + 1, order, Technique::kBeamPoint});
  }
}

}  // namespace turbid
