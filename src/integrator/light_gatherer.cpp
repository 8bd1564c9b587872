#include "integrator/light_gatherer.h"

#include "path/join.h"

namespace turbid {
namespace {

/// Power heuristic with exponent 2 (Veach 1997, sect. 9.2.3) for one sample of each of two techniques.
float mis_weight(float pdf, float other_pdf) {
  if (pdf == 0) return 0;
  const float ratio = other_pdf / pdf;
  return 1 / (1 + ratio * ratio);
}

/// The density with which x2 was chosen from x0, in solid angle at x1. Delta lights: 1.
double pdf_at_x1(const DirectLightSample& from_x0, const DirectLightSample& from_x1) {
  if (from_x0.delta) return 1;
  const auto pdf = static_cast<double>(from_x0.pdf_w);
  if (!std::isfinite(from_x0.distance)) return pdf;
  const auto per_area = [](const DirectLightSample& light) {
    return std::abs(static_cast<double>(dot(light.ng, light.wi))) / sqr(static_cast<double>(light.distance));
  };
  return pdf * per_area(from_x0) / per_area(from_x1);
}

/// What the walk and its last vertex do to choose x2, over what the others do. `choice`: probability of the light.
double advantage_of_walk(float choice, const DirectLightSample& from_x0, const DirectLightSample& from_x1,
                         float hit_pdf_w) {
  if (from_x1.delta) return 1;
  return std::hypot(static_cast<double>(choice * from_x1.pdf_w), static_cast<double>(hit_pdf_w)) /
         (static_cast<double>(choice) * pdf_at_x1(from_x0, from_x1));
}

PathEnd end_at(const Emitter& emitter, const DirectLightSample& light) {
  if (!std::isfinite(light.distance)) return {light.wi, true};
  return {light.position, false, light.delta ? emitter.cone() : Cone{light.ng, std::numbers::pi / 2}};
}

}  // namespace

// --- the vertices of the walk
// -----------------------------------------------------------------------------------------

void LightGatherer::at_sensor(const PathState& state, const Traveller& traveller) {
  if (maker_.active()) depart({traveller.ray().origin, maker_.expected(traveller.medium())}, state, traveller);
}

void LightGatherer::at_collision(const CollisionEvent& event, const PathState& state, const Traveller& traveller) {
  arrival_ = {};
  expected_ = nullptr;
  if (traveller.blind()) return;
  if (departure_.medium && &departure_.medium->phase() == &event.medium.phase())
    arrival_ = {departure_, event.direction, length(event.position - departure_.position),
                event.medium.proxy_sigma_t(event.position), proxy_};
  estimate_direct(event.position, state, traveller, [&](const Vec3& wi) {
    const float f = event.medium.phase().eval(dot(event.direction, wi));
    return Bsdf::Eval{Spectrum(f), f};
  });
  if (!maker_.active()) return;
  expected_ = maker_.expected(&event.medium);
  insert_from(Vertex(event, state), state, traveller);
}

void LightGatherer::left_collision(const CollisionEvent& event, float mu, const Vec3&, const PathState& state,
                                   const Traveller& traveller) {
  if (refraction_) refraction_->left_collision(event, state);
  const float f = event.medium.phase().eval(mu);
  set_out(event.position, traveller.blind() ? 0 : f, state.throughput);
  if (!maker_.active()) return;
  last_arrival_ = arrival_;
  depart({event.position, expected_, true, f}, state, traveller);
}

void LightGatherer::at_surface(const SurfaceEvent& event, const PathState& state, const Traveller& traveller) {
  arrival_ = {};
  if (maker_.active()) expected_ = maker_.expected(event.object, traveller.medium());
  if (!(event.object.bsdf->flags() & lobe::kSmooth)) return;
  const SurfacePoint& point = event.point;
  estimate_direct(
      point.p, state, traveller,
      [&](const Vec3& wi) {
        const Vec3 wi_local = point.to_local(wi);
        if (wi_local.z * dot(wi, point.ng) <= 0) return Bsdf::Eval{};
        return event.object.bsdf->eval(point, event.given_local, wi_local, TransportMode::kRadiance);
      },
      &event);
  if (maker_.active()) insert_from(Vertex(event, state, traveller.medium()), state, traveller);
}

void LightGatherer::left_surface(const SurfaceEvent& event, const BsdfSample& sample, const Vec3& chosen,
                                 const PathState& state, const Traveller& traveller) {
  if (refraction_) refraction_->left_surface(event, sample, traveller);
  set_out(event.point.leave(chosen), sample.pdf_w, state.throughput);
  if (!maker_.active()) return;
  last_arrival_ = {};
  const bool open = !(sample.flags & lobe::kDelta);
  depart({event.point.p, expected_, open, open ? sample.pdf_w : 1}, state, traveller);
}

void LightGatherer::at_light(const Hit& hit, const Object& object, const SurfacePoint& point, const PathState& state,
                             const Traveller& traveller) {
  if ((state.depth == 1 && settings_.hide_emitters) || counted_elsewhere(false)) return;
  const SurfaceEmitter& emitter = *object.emitter;
  const Vec3& direction = traveller.ray().direction;
  const Spectrum Le = emitter.Le(point, -direction);
  if (Le.is_black()) return;
  if (last_pdf_w_ == 0) return gather(state, Le);
  const size_t index = scene_.emitter_index(hit);
  const DirectLightSample light{.wi = direction,
                                .distance = length(point.p - last_position_),
                                .position = point.p,
                                .pdf_w = emitter.pdf_direct_w(last_position_, point.p, point.ng),
                                .ng = point.ng};
  gather(state, Le * hit_weight({&emitter, scene_.choice_prob(index), index}, light));
}

void LightGatherer::at_escape(const PathState& state, const Traveller& traveller) {
  if ((state.depth == 1 && settings_.hide_emitters) || counted_elsewhere(true)) return;
  const Vec3& direction = traveller.ray().direction;
  for (const ChosenEnvironment& environment : scene_.environments()) {
    const Spectrum Le = environment.emitter->Le(direction);
    if (last_pdf_w_ == 0) {
      gather(state, Le);
      continue;
    }
    const DirectLightSample light{
        .wi = direction, .distance = kInfinity, .pdf_w = environment.emitter->pdf_direct_w(direction)};
    gather(state, Le * hit_weight({environment.emitter, environment.prob, environment.index}, light));
  }
}

// --- light asked for
// --------------------------------------------------------------------------------------------------

float LightGatherer::hit_weight(const EmitterChoice& choice, const DirectLightSample& light) const {
  return mis_weight(last_pdf_w_ * passing_prob_, choice.prob * light.pdf_w) *
         share_of_walk(last_arrival_, choice, light, last_pdf_w_);
}

template <class Scatter>
void LightGatherer::estimate_direct(const Vec3& from, const PathState& state, const Traveller& traveller,
                                    const Scatter& scatter, const SurfaceEvent* surface) {
  const auto chosen = choose_end(from);
  if (!chosen || !settings_.order_counts(state.order)) return;
  const auto& [choice, light] = *chosen;
  const Bsdf::Eval scattered = scatter(light.wi);
  if (scattered.value.is_black()) return;
  const float share = share_of_walk(arrival_, choice, light, light.delta ? 0 : scattered.pdf_w);
  if (share == 0) return;

  const Spectrum towards = state.throughput * scattered.value;
  const Ray shadow = ray_to_light(light, surface ? surface->point.leave(light.wi) : from);
  const Passage passage = traveller.look_along(shadow, towards, surface);
  if (passage.prob == 0) return;
  const float weight = light.delta ? 1 : mis_weight(choice.prob * light.pdf_w, scattered.pdf_w * passage.prob);
  add(state.order, towards * passage.transmittance * light.weight * (share * weight / choice.prob));
}

float LightGatherer::share_of_walk(const Edge& arrival, const EmitterChoice& choice, const DirectLightSample& light,
                                   float hit_pdf_w) const {
  if (!arrival.from.medium) return 1;
  const auto from_x0 = choice.emitter->seen_from(arrival.from.position, light);
  if (!from_x0) return 1;
  const double advantage = maker_.weighs() ? advantage_of_walk(choice.prob, *from_x0, light, hit_pdf_w) : 1;
  return static_cast<float>(maker_.walk_weight(arrival, end_at(*choice.emitter, light), advantage));
}

// --- collisions made for a light
// --------------------------------------------------------------------------------------

std::optional<LightGatherer::LightEnd> LightGatherer::choose_end(const Vec3& from) {
  float u_light = sampler_.next_1d();
  const Vec2 u = sampler_.next_2d();
  const EmitterChoice choice = scene_.choose_emitter(u_light);
  if (!choice.emitter) return std::nullopt;
  const auto light = choice.emitter->sample_direct(from, u);
  if (!light) return std::nullopt;
  return LightEnd{choice, *light};
}

/// Once more.
void LightGatherer::insert_from(const Vertex& vertex, const PathState& state, const Traveller& traveller) {
  Departure from{vertex.position, expected_, true};
  if (!maker_.inserts(from)) return;
  const auto light = choose_end(vertex.position);
  const Vec2 u = sampler_.next_2d();
  const float u_phi = sampler_.next_1d();
  if (!light || !may_insert(state)) return;
  const PathEnd end = end_at(*light->choice.emitter, light->sample);
  const auto x1 = maker_.insert(from, end, u.x, u.y, u_phi);
  if (!x1) return;
  const Vertex::Scattering scattered = vertex.scatter(x1->arrives, TransportMode::kRadiance);
  if (scattered.value.is_black()) return;
  const Spectrum leaving = state.throughput * scattered.value;
  const Passage passage = look_along(traveller, vertex, line_to(vertex.leave(x1->arrives), x1->position), leaving);
  if (!scatters_as_expected(from, passage)) return;
  from.pdf_w = scattered.pdf_w;
  CollisionDensities all;
  if (maker_.weighs())
    all = maker_.densities({from, x1->arrives, x1->d1, passage.medium->proxy_sigma_t(x1->position), passage.proxy}, end,
                           x1->pdf_v);
  const double factor = inverse_square(vertex.position, x1->position) / x1->pdf_v;
  finish({x1->position, x1->arrives, *passage.medium}, *light, leaving * passage.transmittance, factor, all,
         &CollisionDensities::inserted, state);
}

/// A new edge begins; it has another end, made for a light.
void LightGatherer::depart(const Departure& from, const PathState& state, const Traveller& traveller) {
  departure_ = from;
  proxy_ = Spectrum(1.0f);
  if (!maker_.marches(from)) return;
  const auto light = choose_end(from.position);
  const float u = sampler_.next_1d();
  if (!light || !may_insert(state) || state.throughput.is_black()) return;
  const PathEnd end = end_at(*light->choice.emitter, light->sample);
  const Vec3& direction = traveller.ray().direction;
  const auto distance = maker_.march(from, direction, end, u);
  if (!distance) return;
  const Passage passage = traveller.look_along({traveller.ray().origin, direction, distance->t}, state.throughput);
  if (!scatters_as_expected(from, passage)) return;
  const Vec3 x1 = from.position + direction * distance->t;
  CollisionDensities all;
  if (maker_.weighs())
    all = maker_.densities({from, direction, distance->t, passage.medium->proxy_sigma_t(x1), passage.proxy}, end);
  finish({x1, direction, *passage.medium}, *light, state.throughput * passage.transmittance, 1 / distance->pdf_t, all,
         &CollisionDensities::along, state);
}

/// From the collision that was made on to the light. `arrived` times `factor`: what comes to it.
void LightGatherer::finish(const CollisionEvent& x1, const LightEnd& light, const Spectrum& arrived, double factor,
                           CollisionDensities all, double CollisionDensities::*own, const PathState& state) {
  const EmitterChoice& choice = light.choice;
  const auto from_x1 = choice.emitter->seen_from(x1.position, light.sample);
  if (!from_x1) return;
  const float f = x1.medium.phase().eval_angle(static_cast<float>(angle_between(x1.direction, from_x1->wi)));
  const Spectrum towards = arrived * x1.medium.sigma_s_at(x1.position) * f;
  if (towards.is_black()) return;
  if (maker_.weighs()) {
    all.walk *= advantage_of_walk(choice.prob, light.sample, *from_x1, choice.emitter->can_be_hit() ? f : 0);
    factor *= ConnectionSampler::weight(all.*own, all);
  }
  const Passage passage =
      pass_straight(scene_, ray_to_light(*from_x1, x1.position), &x1.medium, towards, sampler_, counters_);
  if (passage.prob == 0) return;
  // The weight stands for a density at x1: it is turned into that with which x2 was chosen.
  const double chosen = from_x1->delta ? 1 : static_cast<double>(from_x1->pdf_w) / pdf_at_x1(light.sample, *from_x1);
  const double weight = factor * chosen / static_cast<double>(choice.prob);
  add(state.order + 1, towards * passage.transmittance * from_x1->weight * static_cast<float>(weight));
}

}  // namespace turbid
