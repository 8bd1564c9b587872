#pragma once
#include <limits>

#include "path/contribution.h"
#include "photon/beam_crossing.h"
#include "photon/photon_map.h"
#include "refraction/refractive_interfaces.h"

namespace turbid {

/// Least cosine between the normals of a vertex and a photon on a surface: light at one side of a thin thing must not
/// count on the other, nor around an edge.
inline constexpr float kSameSurface = 0.5f;

/// Radii of the kernels, scene units; constant in each medium, so that both walks of a path know the measures in its
/// weights.
struct KernelRadii {
  float surface = 0, point_point = 0, point_beam = 0, beam_point = 0, beam_beam = 0;
  float inhomogeneous = 0;  ///< of balls in media where flights have no closed form, used whenever anything is merged
  float dense_from = std::numeric_limits<float>::infinity();  ///< Merging::dense_from

  /// The same for all kernels in media.
  static KernelRadii in_media(float radius) { return {0, radius, radius, radius, radius, radius}; }
};

/// How many light paths left points, and how many of them beams.
struct PhotonCounts {
  double paths = 0, beam_paths = 0;
};

/// Number of paths times measure of the kernels (Merging) of the kinds whose radius is not 0.
Merging merging_by(const KernelRadii& radii, const PhotonCounts& counts);

/// How much work merging was.
struct MergeCounters {
  uint64_t point_queries = 0, point_tests = 0;
  uint64_t beam_queries = 0, beam_tests = 0, merges = 0;

  void add(const MergeCounters& other) {
    point_queries += other.point_queries;
    beam_queries += other.beam_queries;
    point_tests += other.point_tests;
    beam_tests += other.beam_tests;
    merges += other.merges;
  }
};

/// What one thread merges with.
struct MergeWork {
  MergeCounters counters;
  struct Found {
    uint32_t beam;
    BeamCrossing crossing;  ///< of points: on_second alone
  };
  std::vector<Found> found;  ///< along one flight, or around one vertex

  /// Beams are found in the order of a hierarchy that depends on the number of threads; they are summed in their own.
  void sort() {
    std::sort(found.begin(), found.end(), [](const Found& a, const Found& b) { return a.beam < b.beam; });
  }
};

/// Merges vertices and flights of walks from the sensor with photons.
class PhotonGatherer {
 public:
  PhotonGatherer(const Scene& scene, const PathSettings& path, const StrategyWeights& weights, const KernelRadii& radii,
                 const PhotonCounts& counts, const PhotonMap& map)
      : scene_(scene), path_(path), weights_(weights), radii_(radii), counts_(counts), map_(map) {}

  /// At a vertex of the walk that knows its StrategySums: P-P3D, B-P2D, photons on surfaces.
  void at(const Vertex& vertex, ContributionSink& sink, MergeWork& work) const;

  /// A flight of the walk.
  struct Flight {
    LightSegment segment;  ///< `flux`: the walk's throughput
    const HomogeneousMedium& medium;
    int depth, order;  ///< edges and collisions before it
    int visit_order;   ///< PathState::visit_order
  };
  /// Along a flight: P-B2D, B-B1D. `sums_at(t)`: the walk's StrategySums at distance t.
  template <class SumsAt>
  void along(const Flight& flight, const SumsAt& sums_at, ContributionSink& sink, MergeWork& work) const;

  /// How far from a beam in the medium it is merged.
  float beam_radius(const HomogeneousMedium& medium) const {
    return radius_in(medium, std::max(radii_.beam_point, radii_.beam_beam));
  }
  bool gathers_along_flights() const { return radii_.point_beam > 0 || radii_.beam_beam > 0; }

 private:
  /// Does a path of so many edges and collisions count, with light that says `bent`? The collision where it is merged
  /// counts on one side only.
  bool counts(int edges, int order, bool bent) const {
    return edges <= path_.max_depth && path_.order_counts(order) && !counted_elsewhere(bent, order);
  }
  /// `radius` in thin media, in this one.
  float radius_in(const HomogeneousMedium& medium, float radius) const {
    return radius * static_cast<float>(weights_.kernel_scale(static_cast<double>(medium.sigma_t().max())));
  }
  void at_surface(const Vertex& vertex, ContributionSink& sink, MergeWork& work) const;
  void points_at(const Vertex& vertex, ContributionSink& sink, MergeWork& work) const;
  void beams_at(const Vertex& vertex, ContributionSink& sink, MergeWork& work) const;

  const Scene& scene_;
  const PathSettings& path_;
  const StrategyWeights& weights_;
  KernelRadii radii_;
  PhotonCounts counts_;
  const PhotonMap& map_;
};

template <class SumsAt>
void PhotonGatherer::along(const Flight& flight, const SumsAt& sums_at, ContributionSink& sink, MergeWork& work) const {
  const Ray& ray = flight.segment.ray;
  const HomogeneousMedium& medium = flight.medium;
  const int sensor_depth = flight.depth + 1;
  const auto add = [&](Technique technique, const Spectrum& value, double own, double merged, double beside,
                       int light_depth, int order) {
    ++work.counters.merges;
    sink.gather({value, static_cast<float>(StrategyWeights::merge_weight(own, merged, beside)), light_depth,
                 sensor_depth + 1, order, technique});
  };

  if (radii_.point_beam > 0 && !map_.collisions().empty()) {
    const float radius = radius_in(medium, radii_.point_beam);
    const float scale = static_cast<float>(1 / (counts_.paths * static_cast<double>(kPi * sqr(radius))));
    ++work.counters.point_queries;
    map_.collisions().along(ray, radius, [&](uint32_t number) {
      ++work.counters.point_tests;
      const PhotonPoint& photon = map_.photons.collisions[number];
      const int order = flight.order + photon.order;
      if (photon.medium != &medium || !counts(sensor_depth + photon.depth, order, photon.bent)) return;
      if (!path_.visit_counts(&medium, flight.visit_order + photon.visit_order)) return;
      const float t = nearest_within(ray, photon.position, radius);
      if (!(t > 0)) return;
      const float mu = -dot(photon.direction, ray.direction);
      const float f = medium.phase().eval(mu);
      const Merges merges = merges_at(weights_, medium, mu);
      const auto pdf_w = static_cast<double>(f);
      const double beside = photon.beside_merge(weights_, pdf_w) + weights_.beside_merge(sums_at(t), pdf_w);
      add(Technique::kPointBeam, flight.segment.flux_at(t, medium) * photon.flux * (f * scale), merges.point_beam,
          merges.sum(), beside, photon.depth, order);
    });
  }

  if (radii_.beam_beam > 0) {
    const float radius = radius_in(medium, radii_.beam_beam);
    const float scale = static_cast<float>(1 / (counts_.beam_paths * 2 * static_cast<double>(radius)));
    work.found.clear();
    ++work.counters.beam_queries;
    map_.beams_along(ray, [&](uint32_t number, float from, float to) {
      ++work.counters.beam_tests;
      const PhotonBeam& beam = map_.photons.beams[number];
      const int order = flight.order + beam.order + 1;
      if (beam.medium != &medium || !counts(sensor_depth + beam.depth + 1, order, beam.bent)) return;
      if (!path_.visit_counts(&medium, flight.visit_order + beam.visit_order + 1)) return;
      const auto crossing = find_crossing(ray, beam.ray(), radius);
      if (crossing && crossing->on_second >= from && crossing->on_second < to)
        work.found.push_back({number, *crossing});
    });
    work.sort();
    for (const auto& [number, crossing] : work.found) {
      const PhotonBeam& beam = map_.photons.beams[number];
      const int order = flight.order + beam.order + 1;
      const float mu = -dot(beam.ray().direction, ray.direction);
      const float f = medium.phase().eval(mu);
      const Merges merges = merges_at(weights_, medium, mu);
      const auto pdf_w = static_cast<double>(f);
      const double beside = weights_.beside_merge(map_.sums_at(scene_, weights_, beam, crossing.on_second), pdf_w) +
                            weights_.beside_merge(sums_at(crossing.on_first), pdf_w);
      add(Technique::kBeamBeam,
          flight.segment.flux_at(crossing.on_first, medium) * beam.segment.flux_at(crossing.on_second, medium) *
              medium.sigma_s() * (f * scale / crossing.sine),
          merges.beam_beam, merges.sum(), beside, beam.depth + 1, order);
    }
  }
}

}  // namespace turbid
