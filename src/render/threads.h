#pragma once
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace turbid {

/// Runs f() with exactly `threads` threads for every parallel_for inside (more than there are cores, if asked for); 0
/// leaves the choice to the machine.
template <class F>
auto with_threads(int threads, const F& f) {
  if (threads <= 0) return f();
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<size_t>(threads));
  tbb::task_arena arena(threads);
  return arena.execute(f);
}

/// Threads that a parallel_for would use here.
inline int thread_count() {
  const auto allowed = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  return std::min(tbb::this_task_arena::max_concurrency(), static_cast<int>(allowed));
}

}  // namespace turbid
