#pragma once
#include <functional>
#include <string>
#include <vector>

#include "integrator/integrator.h"
#include "render/output.h"
#include "render/pass_plan.h"
#include "render/statistics.h"

namespace turbid {

/// What makes the passes: an integrator on its scene, or a stand-in.
struct RenderTask {
  Vec2i size;  ///< of the image, pixels
  std::function<void(uint64_t seed, const StopFlag&)> prepare;
  std::function<bool(const Pass&, Film&, const StopFlag&)> render_pass;
  std::function<Counters()> counters;
  std::vector<std::string> layers = {};  ///< names of the film's layers
};

/// Both must outlive the task.
RenderTask make_task(const Scene& scene, Integrator& integrator);

/// Names of the layers of a film that takes what the integrator makes. Throws SceneError when one of them is taken.
std::vector<std::string> film_layers(const Scene& scene, const Integrator& integrator);

struct RenderOptions {
  Budget budget;
  uint64_t seed = 0;
  OutputSettings output;
  uint64_t fingerprint = 0;     ///< of everything that the image depends on, see Checkpoint
  bool resume = false;          ///< go on from the checkpoint if there is one, and leave one at the end
  double save_seconds = 60;     ///< how often image and checkpoint are written meanwhile; 0: all the time
  bool quiet = false;           ///< no progress
  bool growing_passes = false;  ///< see PassPlan
  /// Called with the sums so far after each whole pass, before the next one; false ends the render as a budget does.
  std::function<bool(const Film&)> after_pass{};
};

struct RenderResult {
  Film film;
  RenderStatistics statistics;
  double seconds = 0;  ///< wall time spent on this image, with that of earlier runs
  std::vector<std::string> files;
  std::string checkpoint;  ///< name of the checkpoint that was left, or empty
};

/// Renders pass after pass until the budget is spent or someone interrupts, and writes the files.
///
/// A pass counts entirely or not at all: one that is cut short, by an interruption or by the end of the time, is thrown
/// away. So is a last pass that is shorter than the others when a render goes on later: its samples are made again, as
/// part of a whole pass. That makes the sums independent of where a render was interrupted, bit for bit.
///
/// SIGINT and SIGTERM end it early, with the image and a checkpoint written; SIGHUP has the image written meanwhile. A
/// render that completes removes its checkpoint, unless it was resumed.
///
/// Throws FileError: a file cannot be written (found out before the first pass), a checkpoint to resume is damaged or
/// belongs to another render. A file that cannot be written meanwhile is a warning.
RenderResult render(const RenderTask& task, const RenderOptions& options);

}  // namespace turbid
