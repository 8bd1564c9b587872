#pragma once
#include <string>

#include "core/vector.h"
#include "integrator/integrator.h"

namespace turbid {

/// What a render cost. Times and counts are of this run, not of earlier ones that it resumed.
struct RenderStatistics {
  Vec2i size{0, 0};
  bool interrupted = false;
  double wall_seconds = 0;     ///< of the render: preparation, passes and files
  double prepare_seconds = 0;  ///< before the first pass
  double pass_seconds = 0;     ///< in passes, an abandoned one included
  double cpu_seconds = 0;      ///< of all threads, preparation included
  uint64_t passes = 0;
  uint64_t samples_per_pixel = 0;  ///< of the image, with those of earlier runs
  uint64_t samples = 0;            ///< taken in this run, over all pixels
  uint64_t peak_memory = 0;        ///< largest resident size of the process, bytes
  Counters counters;               ///< of the integrator

  double samples_per_second() const { return pass_seconds > 0 ? static_cast<double>(samples) / pass_seconds : 0; }
  /// The value of a counter; 0 when the integrator has none of that name.
  uint64_t counter(const std::string& name) const;
};

/// CPU seconds of all threads of the process so far.
double process_cpu_seconds();
/// Largest resident size of the process so far, bytes.
uint64_t process_peak_memory();

/// As JSON text, one value per line. `about` adds texts: scene, integrator, version ...
std::string to_json(const RenderStatistics& statistics, const std::map<std::string, std::string>& about);

}  // namespace turbid
