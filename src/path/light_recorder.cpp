#include "path/light_recorder.h"

namespace turbid {
namespace {

double to_double(float value) { return static_cast<double>(value); }

}  // namespace

StrategySums sums_behind_light(const Scene& scene, const StrategyWeights& weights, const Emission& emission,
                               const EdgeEnd& end, const Spectrum& straight) {
  const Emitter& emitter = *emission.emitter;
  const EmissionPdf& pdf = emission.ray.pdf;
  const Vec3& direction = emission.ray.direction;
  const double arrive = end_factor(end.events, end.cosine, straight);
  const double prob = to_double(emission.prob), direct_prob = to_double(scene.choice_prob(emission.index));
  const double through = end_factor(Spectrum(1.0f), 1, straight);
  StrategySums sums;
  if (emitter.is_environment()) {
    const auto& sky = static_cast<const EnvironmentEmitter&>(emitter);
    const double here = prob * to_double(pdf.pdf_w);
    sums.inverse_pdf = 1 / (to_double(pdf.pdf_a) * arrive);
    sums.joint = weights.power(direct_prob * to_double(sky.pdf_direct_w(-direction)) / here);
    sums.behind = weights.power(through / here);
  } else if (emission.object) {
    const auto& lamp = static_cast<const SurfaceEmitter&>(emitter);
    const double here = prob * to_double(pdf.pdf_a);
    const double inverse = inverse_square(end.position, emission.ray.origin);
    const double back = to_double(std::abs(dot(emission.ray.ng, direction))) * inverse;
    const double direct_w = to_double(lamp.pdf_direct_w(end.position, emission.ray.origin, emission.ray.ng));
    sums.inverse_pdf = 1 / (to_double(pdf.pdf_w) * arrive * inverse);
    sums.joint = weights.power(direct_prob * direct_w * back / here);
    sums.behind = weights.power(back * through / here);
  } else {
    // Cannot be met by chance. Only the choice among lights tells next-event estimation from the walk, whose origin or
    // direction is given.
    const bool parallel = pdf.pdf_w == 0;
    const double density =
        parallel ? to_double(pdf.pdf_a) : to_double(pdf.pdf_w) * inverse_square(end.position, emission.ray.origin);
    sums.inverse_pdf = 1 / ((density > 0 ? density : 1) * arrive);
    sums.joint = emitter.can_be_aimed_at() ? weights.power(direct_prob / prob) : 0;
  }
  if (!weights.joins()) sums.joint = sums.behind = 0;
  return sums;
}

}  // namespace turbid
