#pragma once
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cstddef>

namespace turbid {

/// Runs body(i) for every i in [0, n) on all threads, in no order. Which thread runs what must not change any result.
/// The first exception thrown by a body is rethrown here after the others have stopped.
template <class Body>
void parallel_for(size_t n, const Body& body, size_t grain = 1) {
  tbb::parallel_for(tbb::blocked_range<size_t>(0, n, grain), [&](const tbb::blocked_range<size_t>& range) {
    for (size_t i = range.begin(); i < range.end(); ++i) body(i);
  });
}

}  // namespace turbid
