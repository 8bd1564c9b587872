#include "experiment/contest.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "image/film_image.h"
#include "render/render_job.h"
#include "render/stopwatch.h"

namespace turbid {
namespace {

/// Looks at a render after each pass, says when it has to end, and keeps its errors at the moments of the curve.
class Observer {
 public:
  Observer(const ComparisonRule& rule, int points, const Reference& reference)
      : rule_(rule), reference_(reference), last_level_(points - 1), next_(std::ldexp(1.0, -last_level_)) {}

  bool after_pass(const Film& film) {
    const double cpu = process_cpu_seconds(), wall = clock_.seconds();
    const CurvePoint now{cpu - cpu_begin_ - cpu_aside_, wall - wall_aside_, film.samples()};
    const bool at_end = progress(now) >= 1;
    const bool due = progress(now) >= next_ || at_end;
    bool goes_on = !at_end;
    if (due) {
      while (next_ <= progress(now)) next_ *= 2;
      look(film, now);
      goes_on = goes_on && !(rule_.equal == EqualBy::kError && is_good_enough());
    }
    cpu_aside_ += process_cpu_seconds() - cpu;
    wall_aside_ += clock_.seconds() - wall;
    return goes_on;
  }

  MethodRun take() { return {std::move(curve_), std::move(image_)}; }

 private:
  /// 1 at the end.
  double progress(const CurvePoint& now) const {
    const double by_time = now.seconds / rule_.seconds;
    if (rule_.equal != EqualBy::kSamples) return by_time;
    return std::max(by_time >= 1 ? by_time : 0.0,
                    static_cast<double>(now.samples) / static_cast<double>(rule_.samples));
  }

  void look(const Film& film, CurvePoint now) {
    now.level = last_level_ + std::min(0, static_cast<int>(std::floor(std::log2(progress(now)))));
    image_ = film_to_image(film, false);
    now.error =
        error_of(compare_images(color_channels(image_, "image"), color_channels(reference_.image, "reference")));
    curve_.push_back(now);
  }

  bool is_good_enough() const {
    const double wanted = rule_.error * reference_.error.mean;
    return curve_.back().error.mse - reference_.error.mse.value <= wanted * wanted;
  }

  const ComparisonRule& rule_;
  const Reference& reference_;
  const Stopwatch clock_;
  const double cpu_begin_ = process_cpu_seconds();
  double cpu_aside_ = 0, wall_aside_ = 0;
  int last_level_;
  double next_;  ///< progress at the next point of the curve
  Curve curve_;
  Image image_;
};

}  // namespace

MethodRun run_method(const StagedScene& staged, const ComparisonRule& rule, int points, uint64_t seed,
                     const Reference& reference) {
  const IntegratorSetup setup = staged.make();
  RenderOptions options;
  options.seed = seed;
  options.quiet = true;
  options.growing_passes = true;
  if (rule.equal == EqualBy::kSamples) options.budget.samples = rule.samples;
  Observer observer(rule, points, reference);
  options.after_pass = [&](const Film& film) { return observer.after_pass(film); };
  const RenderResult result = render(make_task(staged.scene(), *setup.integrator), options);
  if (result.statistics.interrupted) throw Interrupted();
  return observer.take();
}

}  // namespace turbid
