#pragma once
#include <array>
#include <functional>

#include "manylight/compact_distributions.h"
#include "manylight/k_d_tree.h"

namespace turbid {

/// What distributes light at places of one kind (surfaces, or collisions), recorded at some of them and mixed at others
/// from those nearby (S2 sect. 4; for surfaces Georgiev et al. 2012, importance caching).
struct CacheSettings {
  size_t surface_points = 1000, volume_points = 1000;
  size_t nearest = 3;                 ///< M, at most ImportanceCache::kMostNearest
  size_t memory = size_t{512} << 20;  ///< bytes, at most; above, fewer points are recorded
};

/// Chooses virtual lights in proportion to what they bring to cache points nearby, shadows included.
///
/// At a place the M nearest points m have weights w_m; the probability of a light is
///   (sum_m w_m p_m + w_u / N) / (sum_m w_m + w_u), w_u = sum_m w_m / M
/// (S2 sect. 4.2; the balance heuristic over the points and uniform choice). It is evaluated in whole for the light
/// that was drawn, whichever part drew it. Points that no light reaches take part as uniform ones.
class ImportanceCache final : public LightSampler {
 public:
  static constexpr size_t kMostNearest = 8;

  /// Records one point: fills in what each light brings to it (any scale). `number` names its random numbers.
  struct Record {
    Vec3 position, normal{0};
    bool valid = false;
  };
  using Recorder = std::function<Record(bool surface, size_t number, std::span<float> weights)>;

  /// Asks `record` for every point, from all threads. `spacing`: the distance that counts as much as a right angle
  /// between normals.
  ImportanceCache(const CacheSettings& settings, size_t lights, float spacing, const Recorder& record);

  std::unique_ptr<Chooser> make_chooser() const override;

  size_t points() const { return surfaces_.size() + volumes_.size(); }
  size_t bytes() const { return rows_.bytes(); }
  /// Fewer points fit into the memory than were asked for.
  bool is_cut() const { return cut_; }

  /// The points that are mixed at a place, with weights that add up to 1 together with that of uniform choice.
  struct Mixture {
    size_t count = 0;
    std::array<uint32_t, kMostNearest> rows;
    std::array<double, kMostNearest> weights;
    double uniform = 1;
  };
  Mixture mixture_at(const Scatterer& place) const;
  const CompactDistributions& rows() const { return rows_; }

 private:
  class MixtureChooser;
  struct Points {
    std::vector<uint32_t> rows;
    size_t size() const { return rows.size(); }
  };

  size_t lights_, nearest_;
  float spacing_;
  bool cut_ = false;
  CompactDistributions rows_;
  Points surfaces_, volumes_;
  KdTree<6> surface_tree_;  ///< positions, and normals times spacing: |n - n'|^2 = 2 (1 - n.n')
  KdTree<3> volume_tree_;
};

}  // namespace turbid
