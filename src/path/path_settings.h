#pragma once
#include <algorithm>
#include <limits>
#include <vector>

namespace turbid {

class Medium;

/// Parameters that all integrators which follow paths share.
struct PathSettings {
  static constexpr int kUnlimited = std::numeric_limits<int>::max();
  int max_depth = kUnlimited;       ///< most edges of a path; 1 sees lights alone, 2 adds one scattering
  int rr_depth = 5;                 ///< edges before Russian roulette begins
  int min_scattering = 0;           ///< only paths with at least this many collisions in media count
  int max_scattering = kUnlimited;  ///< ... and at most this many
  bool hide_emitters = false;       ///< lights are not seen directly
  /// Only paths with fewer collisions than this in each visit (PathState::visit_order) to these media count: what comes
  /// after is found in another way. Walks end there.
  int visit_limit = kUnlimited;
  std::vector<const Medium*> limited_media = {};

  bool visit_counts(const Medium* medium, int visit_order) const {
    return visit_order < visit_limit ||
           std::find(limited_media.begin(), limited_media.end(), medium) == limited_media.end();
  }
  bool order_counts(int order) const { return order >= min_scattering && order <= max_scattering; }
};

}  // namespace turbid
