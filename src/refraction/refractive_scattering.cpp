#include "refraction/refractive_scattering.h"

#include <algorithm>
#include <bit>

#include "refraction/distance_factor.h"
#include "refraction/half_vector.h"
#include "refraction/triangle_filter.h"
#include "surface/fresnel.h"

namespace turbid {
namespace {
/// Up to so many lights are all followed; of more, one that is chosen by its power.
constexpr size_t kFewLights = 8;
}  // namespace

RefractiveScattering::RefractiveScattering(const Scene& scene, const RefractiveSettings& settings)
    : scene_(scene), settings_(settings), interfaces_(scene) {
  std::vector<float> powers;
  for (const Emitter* emitter : scene.emitters()) {
    if (!emitter->can_be_aimed_at() || (emitter->is_environment() && !settings.environments)) continue;
    lights_.push_back({emitter, 1});
    powers.push_back(emitter->power().mean());
  }
  if (lights_.size() <= kFewLights) return;
  choice_ = DiscreteDistribution(powers);
  for (size_t i = 0; i < lights_.size(); ++i) lights_[i].prob = choice_.prob(i);
}

/// One call of gather().
class RefractiveScattering::Gathering {
 public:
  Gathering(const RefractiveScattering& whole, const Ray& flight, const Medium& medium, const Spectrum& throughput,
            const Sampler& sampler, SampleCounters& counters)
      : whole_(whole),
        scene_(whole.scene_),
        settings_(whole.settings_),
        interfaces_(whole.interfaces_),
        flight_(flight),
        medium_(medium),
        throughput_(throughput),
        sampler_(sampler),
        counters_(counters),
        // Not along the flight: those numbers are the attenuation's, where the medium differs from place to place.
        rng_(sampler.aside(flight.origin, -flight.direction)),
        segment_{{V3d(flight.origin), V3d(flight.direction).normalized()}, 0, static_cast<double>(flight.t_max)} {}

  Spectrum run() {
    if (whole_.lights_.size() <= kFewLights) {
      for (const Light& light : whole_.lights_) follow(light);
    } else {
      follow(whole_.lights_[whole_.choice_.sample(rng_.next_float()).index]);
    }
    counters_.unresolved_triangles += finder_.unresolved();
    return result_;
  }

 private:
  void follow(const Light& of) {
    const auto light = LightSample::draw(scene_, *of.emitter, of.prob, rng_);
    if (!light) return;
    light_ = &*light;
    if (settings_.method == RefractiveMethod::kStraightLine) {
      for (int i = 0; i < settings_.samples; ++i) look_straight(stratified(i, settings_.samples) * segment_.to);
      return;
    }
    for (const RefractiveInterface& one : interfaces_.all())
      for (const bool light_inside : {false, true})
        if (one.may_have(&medium_, !light_inside)) follow(one, light_inside);
  }

  double stratified(int i, int count) { return (i + (settings_.in_middle ? 0.5 : rng_.next_double())) / count; }

  void follow(const RefractiveInterface& one, bool light_inside) {
    interface_ = &one;
    light_inside_ = light_inside;
    eta_ = one.eta(light_inside);
    if (settings_.method == RefractiveMethod::kPointSampling) {
      for (int i = 0; i < settings_.samples; ++i) {
        const double t = stratified(i, settings_.samples) * segment_.to;
        one.tree.visit(light_->point(), eta_, light_inside, {segment_.line, t, t},
                       [&](uint32_t triangle, double, double) { connect(triangle, t); });
      }
    } else {
      integrate_all();
    }
  }

  void integrate_all() {
    candidates_.clear();
    interface_->tree.visit(light_->point(), eta_, light_inside_, segment_,
                           [&](uint32_t triangle, double, double) { candidates_.push_back(triangle); });
    const TriangleFilter filter(*interface_->mesh, light_->point(), eta_, light_inside_, segment_);
    std::span<const uint32_t> left = candidates_;
    while (!left.empty()) {
      const auto few = left.first(std::min(TriangleFilter::kLanes, left.size()));
      for (uint32_t lanes = filter.may_contribute(few); lanes != 0; lanes &= lanes - 1)
        integrate(few[static_cast<size_t>(std::countr_zero(lanes))]);
      left = left.subspan(few.size());
    }
  }

  Facet lit_facet(uint32_t triangle) const {
    const Facet facet = facet_of(*interface_->mesh, triangle);
    return light_inside_ ? facet.flipped() : facet;
  }

  bool lit(const Facet& facet) const {
    const LightPoint& light = light_->point();
    return (light.at_infinity ? light.place : light.place - facet.p0).dot(facet.ng) > 0;
  }

  /// All that one triangle refracts towards the flight.
  void integrate(uint32_t triangle) {
    const Facet facet = lit_facet(triangle);
    const Pencil pencil(facet, light_->point(), eta_);
    for (const ContourPiece& piece : finder_.find(pencil, segment_)) {
      const double share = piece.to - piece.from;
      const int count = settings_.samples;
      for (int i = 0; i < count; ++i) {
        const double x = piece.from + share * stratified(i, count);
        const auto point = ContourFinder::point(pencil, segment_.line, piece, x, settings_.tolerance);
        if (!point) {
          ++counters_.unresolved_triangles;
          continue;
        }
        const Pencil::Ray& ray = point->there.ray;
        const double t = point->encounter.on_line, s = point->encounter.on_ray;
        if (!(s > 0 && t > segment_.from && t < segment_.to) || !pencil.valid(ray)) continue;
        const double flux = ray.cos_light * -ray.direction.dot(facet.ng) / (ray.cos_refracted * sqr(ray.distance));
        double spread = point->slope / (facet.area2 * flux);
        if (!settings_.focusing) spread *= straight_spread(facet, pencil, *point);
        add(facet, triangle, point->at, ray.direction, t, piece.width() * share / count / spread);
      }
    }
  }

  /// What the square of the distance puts in the place of D / eta^2.
  double straight_spread(const Facet& facet, const Pencil& pencil, const ContourPoint& point) const {
    const Pencil::Ray& ray = point.there.ray;
    const V3d v = segment_.line.at(point.encounter.on_line);
    const RefractedPath path{v, ray.p, ray.normal, point.at, pencil.eta(), light_->point()};
    const double distance = light_->at_infinity() ? 1 : point.encounter.on_ray + ray.distance;
    return sqr(distance * pencil.eta()) / distance_factor(facet, path);
  }

  /// The paths through one triangle to V(t): those that Newton's method finds from its starts.
  void connect(uint32_t triangle, double t) {
    const Facet facet = lit_facet(triangle);
    if (!lit(facet)) return;
    const HalfVector function(facet, light_->point(), eta_, segment_.line);
    const int side = settings_.starts;
    constexpr double kSame = 1e-6;  // in the triangle's coordinates
    roots_.clear();
    for (int i = 0; i < side; ++i)
      for (int j = 0; i + j < side; ++j) {
        const auto at = function.solve(t, V2d(i + 1.0 / 3, j + 1.0 / 3) / side, settings_.tolerance);
        if (!at || !inside_triangle(*at)) continue;
        if (std::any_of(roots_.begin(), roots_.end(), [&](const V2d& known) { return (known - *at).length() < kSame; }))
          continue;
        roots_.push_back(*at);
        connect(facet, triangle, *at, t);
      }
  }

  void connect(const Facet& facet, uint32_t triangle, const V2d& at, double t) {
    const Pencil pencil(facet, light_->point(), eta_);
    const Pencil::Ray ray = pencil.ray(at);
    const V3d v = segment_.line.at(t);
    // f is zero, too, where V lies on the light's side in the mirror image of that direction.
    if (!pencil.valid(ray) || !((v - ray.p).dot(ray.normal) < 0)) return;
    const RefractedPath path{v, ray.p, ray.normal, at, eta_, light_->point()};
    const double distance = light_->at_infinity() ? 1 : (v - ray.p).length() + ray.distance;
    const double spread = settings_.focusing ? distance_factor(facet, path) / sqr(eta_) : sqr(distance);
    add(facet, triangle, at, ray.direction, t, segment_.to / (settings_.samples * spread));
  }

  /// Adds the path over P at V(t); `factor`: all that geometry makes of the light's intensity, and the step along the
  /// flight. `direction`: of the refracted ray.
  void add(const Facet& facet, uint32_t triangle, const V2d& at, const V3d& direction, double t, double factor) {
    if (!shades_with_blend(facet, at)) return;
    const SurfacePoint p = interface_->mesh->point_on_triangle(triangle, Vec2(at));
    const V3d place = facet.position(at);
    const LightPoint& light = light_->point();
    const Vec3 to_light((light.at_infinity ? light.place : light.place - place).normalized());
    const Vec3 v(segment_.line.at(t)), to_v(direction);
    Spectrum value = light_->emitted(-to_light) * scattered(t, dot(to_v, -flight_.direction)) * transmitted(p, to_v);
    value *= static_cast<float>(factor);
    if (value.is_black()) return;
    ++counters_.refractive_paths;
    result_ += value * let_through(p, v, to_v, to_light);
  }

  /// sigma_s f T of a collision at V(t).
  Spectrum scattered(double t, float mu) const {
    const auto distance = static_cast<float>(t);
    return medium_.sigma_s_at(flight_.at(distance)) * medium_.phase().eval(mu) *
           medium_.transmittance({flight_.origin, flight_.direction, distance}, sampler_);
  }

  /// Fresnel's factor and the boundary's colour.
  Spectrum transmitted(const SurfacePoint& p, const Vec3& to_v) const {
    const Vec3 given = p.to_local(to_v);
    const auto index_ratio = static_cast<float>(1 / eta_);  // index on the other side / here
    const float reflectance = fresnel_dielectric(std::abs(given.z), index_ratio).reflectance;
    const auto lobe = interface_->bsdf->sample(p, given, kOneMinusEpsilon, Vec2(0.5f), TransportMode::kImportance);
    return lobe && (lobe->flags & lobe::kTransmission) ? lobe->weight * (1 - reflectance) : Spectrum(0.0f);
  }

  /// What comes from the light to P and from there to V.
  Spectrum let_through(const SurfacePoint& p, const Vec3& v, const Vec3& to_v, const Vec3& to_light) const {
    const Passage inner =
        pass_straight(scene_, line_between(v, p.leave(to_v)), &medium_, throughput_, sampler_, counters_);
    if (inner.prob == 0 || inner.medium != &medium_) return Spectrum(0.0f);
    const Object& object = *interface_->object;
    const Medium* beyond = object.bounds_media ? object.medium_towards(p.ng, to_light) : &medium_;
    const Vec3 from = p.leave(to_light);
    const Ray line = light_->at_infinity() ? Ray{from, to_light} : line_between(from, light_->position());
    return inner.transmittance *
           pass_straight(scene_, line, beyond, throughput_ * inner.transmittance, sampler_, counters_).transmittance;
  }

  /// The straight line from V(t) to the light, over the first interface that it meets.
  void look_straight(double t) {
    const auto distance = static_cast<float>(t);
    const Vec3 v = flight_.at(distance);
    const LightPoint& light = light_->point();
    const Vec3 to_light((light.at_infinity ? light.place : light.place - V3d(v)).normalized());
    const Hit hit = scene_.rays().intersect({v, to_light});
    ++counters_.shadow_rays;
    if (!hit) return;
    interface_ = interfaces_.find(scene_.object(hit));
    if (!interface_) return;
    const SurfacePoint p = interface_->mesh->surface_point({v, to_light}, hit);
    light_inside_ = leads_outside(p.ng, -to_light);
    if (!interface_->may_have(&medium_, !light_inside_)) return;
    eta_ = 1;  // nothing bends
    const float far = light_->at_infinity() ? 1 : length(light_->position() - v);
    const float reflectance =
        fresnel_dielectric(std::abs(dot(p.shading.n, to_light)), static_cast<float>(interface_->eta(light_inside_)))
            .reflectance;
    const Spectrum value = light_->emitted(-to_light) * scattered(t, dot(-to_light, -flight_.direction)) *
                           static_cast<float>(segment_.to / settings_.samples) * ((1 - reflectance) / sqr(far));
    ++counters_.refractive_paths;
    if (!value.is_black()) result_ += value * let_through(p, v, -to_light, to_light);
  }

  const RefractiveScattering& whole_;
  const Scene& scene_;
  const RefractiveSettings& settings_;
  const RefractiveInterfaces& interfaces_;
  const Ray& flight_;
  const Medium& medium_;
  const Spectrum& throughput_;
  const Sampler& sampler_;
  SampleCounters& counters_;
  Rng rng_;
  Segment segment_;

  const LightSample* light_ = nullptr;
  const RefractiveInterface* interface_ = nullptr;  ///< that is looked through
  bool light_inside_ = false;
  double eta_ = 1;  ///< index at V / index at the light
  ContourFinder finder_;
  std::vector<uint32_t> candidates_;  ///< triangles that the tree names
  std::vector<V2d> roots_;            ///< of one triangle
  Spectrum result_{0.0f};
};

Spectrum RefractiveScattering::gather(const Ray& flight, const Medium& medium, const Spectrum& throughput,
                                      const Sampler& sampler, SampleCounters& counters) const {
  if (settings_.method == RefractiveMethod::kNone) return Spectrum(0.0f);
  if (interfaces_.all().empty() || medium.sigma_s().is_black()) return Spectrum(0.0f);
  return Gathering(*this, flight, medium, throughput, sampler, counters).run();
}

}  // namespace turbid
