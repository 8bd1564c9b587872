#include "render/render_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <mutex>

#include "core/error.h"
#include "core/log.h"
#include "image/outlier_rejection.h"
#include "render/checkpoint.h"
#include "render/progress.h"
#include "render/signals.h"
#include "render/stopwatch.h"
#include "render/ticker.h"

namespace turbid {
namespace {

using namespace std::chrono_literals;

/// Signals and the end of the time are noticed after this long.
constexpr auto kWatchPause = 10ms;
constexpr auto kSavePause = 20ms;
/// Saving may take this share of the time: after a slow save the next one waits longer.
constexpr double kSavingShare = 0.05;

/// One render under way: the loop over passes in the calling thread, a thread that watches signals, clock and progress,
/// and one that saves.
class Job {
 public:
  Job(const RenderTask& task, const RenderOptions& options)
      : task_(task),
        options_(options),
        plan_(options.growing_passes ? PassPlan::growing(options.budget, options.seed)
                                     : PassPlan(task.size, options.budget, options.seed)),
        output_(options.output),
        total_(task.size, task.layers) {
    output_.tells_passes = !options.growing_passes;
  }

  RenderResult run() {
    check_output(output_);
    start_from_checkpoint();
    ProgressBar bar(options_.quiet);
    {
      const Ticker watcher(kWatchPause, [&] { watch(bar); });
      const Ticker saver(kSavePause, [&] { save_meanwhile(); });
      make_passes();
    }
    bar.clear();
    return finish();
  }

 private:
  bool has_files() const { return !output_.path.empty(); }
  std::string checkpoint_path() const { return output_.checkpoint_path(); }
  double image_seconds() const { return seconds_before_ + clock_.seconds(); }

  void start_from_checkpoint() {
    if (!has_files()) return;
    const std::string path = checkpoint_path();
    if (!std::filesystem::exists(path)) {
      if (options_.resume) log_notice("there is no checkpoint " + path + ": starting from the beginning");
      return;
    }
    if (!options_.resume) return warn_about_old_checkpoint(path);
    const std::string advice = "; delete it or render without --resume to start from the beginning";
    Checkpoint checkpoint;
    try {
      checkpoint = read_checkpoint(path);
    } catch (const FileError& error) {
      throw Error(error.what() + advice, error.exit_code());
    }
    if (!belongs_here(checkpoint))
      throw FileError(
          path, "is the checkpoint of another render (its scene, integrator, size, seed or version differ)" + advice);
    total_ = std::move(checkpoint.film);
    seconds_before_ = checkpoint.seconds;
    samples_before_ = saved_samples_ = total_.samples();
    if (plan_.target() && samples_before_ > *plan_.target())
      log_warning(
          fmt::format("{} already holds {} samples per pixel, more than the {} asked for; the image has all of them",
                      path, samples_before_, *plan_.target()));
  }

  bool belongs_here(const Checkpoint& checkpoint) const {
    return checkpoint.fingerprint == options_.fingerprint && checkpoint.film.size() == task_.size &&
           checkpoint.film.layer_names() == task_.layers && checkpoint.film.samples() % plan_.samples_per_pass() == 0;
  }

  void warn_about_old_checkpoint(const std::string& path) const {
    if (!looks_like_checkpoint(path))
      throw FileError(path, "is in the way of the checkpoint and is none: move it or choose another -o");
    try {
      const Checkpoint checkpoint = read_checkpoint(path);
      if (belongs_here(checkpoint))
        log_warning(fmt::format(
            "{} holds {} samples per pixel of this render, which are lost now; --resume would go on from them", path,
            checkpoint.film.samples()));
    } catch (const FileError&) {
      // It is damaged: nothing is lost by replacing it.
    }
  }

  void make_passes() {
    task_.prepare(options_.seed, stop_);
    statistics_.prepare_seconds = clock_.seconds();
    Film film(task_.size, task_.layers);
    for (auto pass = plan_.next(total_.samples()); pass && !stop_.requested(); pass = plan_.next(total_.samples())) {
      film.clear();
      if (!task_.render_pass(*pass, film, stop_)) break;
      ++statistics_.passes;
      statistics_.samples += film.samples() * film.pixel_count();
      {
        const std::lock_guard lock(mutex_);
        if (pass->sample_count < plan_.samples_per_pass()) {
          short_pass_ = std::move(film);
          break;
        }
        total_.add(film);
      }
      // Only this thread changes the sums.
      if (options_.after_pass && !options_.after_pass(total_)) break;
    }
    statistics_.pass_seconds = clock_.seconds() - statistics_.prepare_seconds;
  }

  /// Called by the watching thread.
  void watch(ProgressBar& bar) {
    uint64_t samples = 0;
    {
      const std::lock_guard lock(mutex_);
      samples = total_.samples();
    }
    const double elapsed = clock_.seconds();
    const bool time_is_up = options_.budget.seconds && elapsed >= *options_.budget.seconds && samples > samples_before_;
    if (signals_.interrupted() || time_is_up) stop_.request();
    bar.update({samples, plan_.target(), options_.budget.seconds, elapsed, samples_before_,
                static_cast<double>(total_.pixel_count())});
  }

  /// Called by the saving thread.
  void save_meanwhile() {
    if (!has_files() || stop_.requested()) return;
    image_requested_ = signals_.take_image_request() || image_requested_;
    const double now = clock_.seconds();
    const bool due = now >= next_save_;
    if (!due && !image_requested_) return;
    Film snapshot;
    {
      const std::lock_guard lock(mutex_);
      if (total_.samples() == (image_requested_ ? 0 : saved_samples_)) return;
      snapshot = total_;
    }
    try {
      write_output(output_, snapshot, image_seconds());
      if (due) write_checkpoint(checkpoint_path(), options_.fingerprint, image_seconds(), snapshot);
    } catch (const std::exception& error) {
      log_warning(error.what());
    }
    image_requested_ = false;
    saved_samples_ = snapshot.samples();
    const double cost = clock_.seconds() - now;
    next_save_ =
        clock_.seconds() + (options_.save_seconds > 0 ? std::max(options_.save_seconds, cost / kSavingShare) : 0);
  }

  RenderResult finish() {
    RenderResult result;
    statistics_.interrupted = signals_.interrupted() && !short_pass_.pixel_count() && plan_.next(total_.samples());
    const bool keeps_checkpoint = has_files() && total_.samples() > 0 && (statistics_.interrupted || options_.resume);
    result.seconds = image_seconds();
    std::exception_ptr failure;  // one file that cannot be written must not cost the others
    if (keeps_checkpoint) {
      try {
        write_checkpoint(checkpoint_path(), options_.fingerprint, result.seconds, total_);
        result.checkpoint = checkpoint_path();
      } catch (const FileError&) {
        failure = std::current_exception();
      }
    }
    if (short_pass_.pixel_count()) total_.add(short_pass_);
    if (total_.samples() > 0) result.files = write_output(output_, total_, result.seconds);
    if (failure) std::rethrow_exception(failure);
    if (has_files() && !keeps_checkpoint && !statistics_.interrupted) {
      std::error_code ignored;
      std::filesystem::remove(checkpoint_path(), ignored);
    }
    statistics_.size = task_.size;
    statistics_.wall_seconds = clock_.seconds();
    statistics_.cpu_seconds = process_cpu_seconds() - cpu_before_;
    statistics_.samples_per_pixel = total_.samples();
    statistics_.peak_memory = process_peak_memory();
    statistics_.counters = task_.counters();
    result.statistics = statistics_;
    result.film = std::move(total_);
    return result;
  }

  const RenderTask& task_;
  const RenderOptions& options_;
  const PassPlan plan_;
  OutputSettings output_;
  const Stopwatch clock_;
  const double cpu_before_ = process_cpu_seconds();
  SignalGuard signals_;
  StopFlag stop_;
  RenderStatistics statistics_;

  std::mutex mutex_;  ///< guards total_ while there are other threads
  Film total_;        ///< whole passes
  Film short_pass_;   ///< the last pass where it is shorter than the others: part of the image, not of a checkpoint
  double seconds_before_ = 0;
  uint64_t samples_before_ = 0;

  // Of the saving thread.
  double next_save_ = options_.save_seconds;
  bool image_requested_ = false;
  uint64_t saved_samples_ = 0;
};

}  // namespace

std::vector<std::string> film_layers(const Scene& scene, const Integrator& integrator) {
  std::vector<std::string> names = integrator.layer_names();
  if (!scene.film().outliers) return names;
  for (const char* taken : kUnweightedNames)
    if (std::ranges::find(names, taken) != names.end())
      throw SceneError(
          fmt::format("layer '{}' of the integrator needs another name: outlier_rejection of the film "
                      "writes one of that name",
                      taken));
  for (std::string& name : Cascades::layer_names()) names.push_back(std::move(name));
  return names;
}

RenderTask make_task(const Scene& scene, Integrator& integrator) {
  return {scene.film().image_size(),
          [&](uint64_t seed, const StopFlag& stop) { integrator.prepare(scene, seed, stop); },
          [&](const Pass& pass, Film& film, const StopFlag& stop) {
            return integrator.render_pass(scene, pass, film, stop);
          },
          [&] { return integrator.counters(); }, film_layers(scene, integrator)};
}

RenderResult render(const RenderTask& task, const RenderOptions& options) { return Job(task, options).run(); }

}  // namespace turbid
