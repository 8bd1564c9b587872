#pragma once
#include <functional>
#include <vector>

namespace turbid {

/// A function's value at a place.
struct Node {
  double at, value;
};

/// When refine() is content.
struct RefinementSettings {
  double tolerance = 5e-4;    ///< of the value half-way, relative to it
  double floor = 0.01;        ///< of the larger neighbour's value: deviations are never judged finer than against this
  double smallest = 1e-6;     ///< intervals are not cut below this part of their place: where the function jumps
  size_t most_nodes = 16384;  ///< no further round begins with more
  /// Evaluate on all threads, for slow functions. Never under a lock: a thread that waits may take up any other task.
  bool in_parallel = false;
};

/// Nodes between which a non-negative function is nearly linear in `coordinate(place)`: begins with the intervals
/// between `start` (two or more places in ascending order) and cuts in halves those in whose middle the function is not
/// where the line says. Middles that were looked at stay only where they help, so the function is met within about
/// half of the tolerance.
std::vector<Node> refine(const std::function<double(double)>& function, const std::function<double(double)>& coordinate,
                         const std::vector<double>& start, const RefinementSettings& settings = {});

}  // namespace turbid
