#include "medium/refinement.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"

namespace turbid {
namespace {

/// An interval between two nodes; unsettled while its middle is to be looked at.
struct Interval {
  Node begin, end;
  bool settled = false;
};

std::vector<Node> evaluate(const std::function<double(double)>& function, const std::vector<double>& places,
                           bool in_parallel) {
  std::vector<Node> nodes(places.size());
  const auto look = [&](size_t i) { nodes[i] = {places[i], function(places[i])}; };
  if (in_parallel)
    parallel_for(places.size(), look, 16);
  else
    for (size_t i = 0; i < places.size(); ++i) look(i);
  return nodes;
}

}  // namespace

std::vector<Node> refine(const std::function<double(double)>& function, const std::function<double(double)>& coordinate,
                         const std::vector<double>& start, const RefinementSettings& settings) {
  // How far the middle is from the line, in tolerances.
  const auto deviation = [&](const Node& a, const Node& middle, const Node& b) {
    const double xa = coordinate(a.at), xb = coordinate(b.at);
    const double t = (coordinate(middle.at) - xa) / (xb - xa);
    const double line = a.value + t * (b.value - a.value);
    const double scale = std::max(middle.value, settings.floor * std::max(a.value, b.value));
    return std::abs(middle.value - line) / (settings.tolerance * std::max(scale, 1e-300));
  };

  const std::vector<Node> first = evaluate(function, start, settings.in_parallel);
  std::vector<Interval> intervals;
  for (size_t i = 0; i + 1 < first.size(); ++i) intervals.push_back({first[i], first[i + 1]});

  for (bool again = true; again && intervals.size() < settings.most_nodes;) {
    std::vector<double> middles;
    for (const Interval& interval : intervals)
      if (!interval.settled) middles.push_back((interval.begin.at + interval.end.at) / 2);
    const std::vector<Node> looked_at = evaluate(function, middles, settings.in_parallel);
    again = false;
    std::vector<Interval> next;
    auto middle = looked_at.begin();
    for (const Interval& interval : intervals) {
      if (interval.settled) {
        next.push_back(interval);
        continue;
      }
      const Node &begin = interval.begin, &end = interval.end;
      const double off = end.at - begin.at > settings.smallest * end.at ? deviation(begin, *middle, end) : 0;
      if (off <= 0.25) {
        next.push_back({begin, end, true});
      } else {
        const bool settled = off <= 1;  // each half is then four times better
        next.push_back({begin, *middle, settled});
        next.push_back({*middle, end, settled});
        again = again || !settled;
      }
      ++middle;
    }
    intervals = std::move(next);
  }

  std::vector<Node> nodes{intervals.front().begin};
  for (const Interval& interval : intervals) nodes.push_back(interval.end);
  return nodes;
}

}  // namespace turbid
