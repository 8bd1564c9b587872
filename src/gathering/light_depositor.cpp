#include "gathering/light_depositor.h"

namespace turbid {
namespace {

float disk_area(float radius) { return kPi * sqr(radius); }
float ball_volume(float radius) { return 4.0f / 3 * kPi * sqr(radius) * radius; }

/// Light at one side of a thin thing must not count on the other, nor around an edge.
constexpr float kSameSurface = 0.5f;

}  // namespace

void LightDepositor::on_segment(const Ray& way, const Medium& medium, const PathState& state,
                                const Traveller::Leg& leg) {
  if (rough_ > 0 && !plan_.gather.surface_light_in_volumes) return;
  if (store_.volumes().empty()) return;
  ++deposits_.segments;
  const HomogeneousMedium* homogeneous = medium.as_homogeneous();
  if (homogeneous && plan_.gather.estimator == GatherSettings::Estimator::kTrack) {
    LightSegment segment{way, state.throughput, plan_.gather.long_segments, channel_mix(state.throughput)};
    if (segment.is_long && leg.collides) segment.ray.t_max = length_to_surface(plan_.scene, way, medium, counters_);
    fly_through(segment, *homogeneous, state);
  } else if (leg.collides) {
    collide(way.at(way.t_max), way.direction, medium, state.throughput * leg.weight, state);
  }
}

bool LightDepositor::takes(const GatherVolume& volume, const Medium& medium, const PathState& state) const {
  if (volume.medium != &medium) return false;
  const bool scattered = rough_ > 0 || state.order > 0;
  if (scattered && !volume.last) return false;
  return state.depth + 1 + volume.depth <= plan_.path.max_depth && plan_.path.order_counts(state.order + volume.order);
}

/// Spheres: S5 eq. 11. Light counts when it crosses the disk through the centre perpendicular to its own direction;
/// counting all that touch the sphere would be wrong in first order.
void LightDepositor::fly_through(const LightSegment& segment, const HomogeneousMedium& medium, const PathState& state) {
  const Ray& ray = segment.ray;
  store_.volumes().along(ray, [&](uint32_t number) {
    ++deposits_.tests;
    const GatherVolume& volume = store_.found.volumes[number];
    if (!takes(volume, medium, state)) return;
    const float factor = medium.phase().eval(-dot(ray.direction, volume.direction)) / disk_area(volume.radius);
    const Spectrum front = volume.weight * medium.sigma_s() * factor;
    if (volume.is_sphere()) {
      const float t = nearest_within(ray, volume.origin, volume.radius);
      if (t > 0) deposit(volume, front * segment.flux_at(t, medium), state);
      return;
    }
    const Chord chord = chord_in(ray, volume);
    if (chord.empty()) return;
    const float u =
        medium.is_grey() ? 0 : sampler_.aside(Purpose::kGatheredChord, volume.origin, ray.direction).next_float();
    deposit(volume, front * flux_through(segment, volume, chord, plan_.gather.long_cylinders, medium, u), state);
  });
}

/// `scattered`: what the walk carries behind the collision, the flux times the albedo.
void LightDepositor::collide(const Vec3& p, const Vec3& direction, const Medium& medium, const Spectrum& scattered,
                             const PathState& state) {
  store_.volumes().around(p, [&](uint32_t number) {
    ++deposits_.tests;
    const GatherVolume& volume = store_.found.volumes[number];
    if (!takes(volume, medium, state)) return;
    const Vec3 from = p - volume.origin;
    const float f = medium.phase().eval(-dot(direction, volume.direction));
    if (volume.is_sphere()) {
      if (length_squared(from) < sqr(volume.radius))
        deposit(volume, volume.weight * scattered * (f / ball_volume(volume.radius)), state);
      return;
    }
    const float along = dot(from, volume.direction);
    if (along < 0 || along >= volume.length || !(length_squared(from - volume.direction * along) < sqr(volume.radius)))
      return;
    const Spectrum weight = volume.weight * weight_along(volume, volume.start + along, plan_.gather.long_cylinders,
                                                         *medium.as_homogeneous());
    deposit(volume, weight * scattered * (f / disk_area(volume.radius)), state);
  });
}

/// The flux that arrives around a point, over the area, scattered as there: F f |cos_s| / (|cos_g| pi R^2), where cos_s
/// is what scattering is defined with and cos_g what turns flux into irradiance.
void LightDepositor::at_surface(const SurfaceEvent& event, const PathState& state, const Traveller&) {
  if (!plan_.gather.disks || !(event.object.bsdf->flags() & lobe::kSmooth)) return;
  const bool asked_for = state.depth == 1 && aimed_at_;
  if (asked_for) return;
  const Vec3 p = event.point.p, wi = event.given;
  const float cosine = std::abs(dot(event.point.ng, wi));
  store_.disks().around(p, [&](uint32_t number) {
    const GatherDisk& disk = store_.found.disks[number];
    const Vertex& vertex = disk.vertex;
    if (!(length_squared(p - vertex.position) < sqr(disk.radius))) return;
    if (dot(event.point.ng, vertex.point.ng) < kSameSurface) return;
    const int order = state.order + vertex.order;
    if (state.depth + vertex.depth > plan_.path.max_depth || !plan_.path.order_counts(order)) return;
    const Vec3 wi_local = vertex.point.to_local(wi);
    if (!(wi_local.z * dot(wi, vertex.point.ng) > 0)) return;
    const Spectrum f =
        vertex.object->bsdf->eval(vertex.point, vertex.given_local, wi_local, TransportMode::kRadiance).value;
    deposit(disk.pixel, vertex.throughput * f * state.throughput / (cosine * disk_area(disk.radius)), state.depth,
            vertex.depth + 1, order);
  });
}

void LightDepositor::deposit(uint32_t pixel, const Spectrum& value, int light_vertices, int sensor_vertices,
                             int order) {
  ++deposits_.deposits;
  sink_->splat(pixel, {value * inverse_paths_, 1, light_vertices, sensor_vertices, order});
}

}  // namespace turbid
