#pragma once
#include <array>
#include <functional>

#include "manylight/compact_distributions.h"
#include "manylight/k_d_tree.h"

namespace turbid {

/// Places of each kind have cache points of their own: what lights bring to a surface depends on its side, to a whole
/// way on where it leads (S2 Fig. 4).
enum class PlaceKind : uint8_t { kSurface, kCollision, kWay };
inline constexpr size_t kPlaceKinds = 3;

/// What lights bring to places, recorded at some of them and mixed at others from those nearby (S2 sect. 4; for
/// surfaces Georgiev et al. 2012, importance caching).
struct CacheSettings {
  std::array<size_t, kPlaceKinds> points = {1000, 1000, 0};
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
    Vec3 position{0};   ///< of ways: where they begin
    Vec3 direction{0};  ///< of surfaces the normal, of ways where they lead; collisions: zero
    bool valid = false;
  };
  using Recorder = std::function<Record(PlaceKind kind, size_t number, std::span<float> weights)>;

  /// Asks `record` for every point, from all threads. `spacing`: by kind, the distance that counts as much as a right
  /// angle between directions.
  ImportanceCache(const CacheSettings& settings, size_t lights, const std::array<float, kPlaceKinds>& spacing,
                  const Recorder& record);

  std::unique_ptr<Chooser> make_chooser() const override;

  size_t points() const;
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
  Mixture mixture_at(PlaceKind kind, const Vec3& position, const Vec3& direction) const;
  const CompactDistributions& rows() const { return rows_; }

 private:
  class MixtureChooser;
  using Tree = KdTree<6>;  ///< positions, and directions times spacing: |n - n'|^2 = 2 (1 - n.n')
  struct Kind {
    float spacing = 0;
    std::vector<uint32_t> rows;
    Tree tree;

    Tree::Point where(const Vec3& p, const Vec3& d) const {
      return {p.x, p.y, p.z, d.x * spacing, d.y * spacing, d.z * spacing};
    }
  };

  size_t lights_, nearest_;
  bool cut_ = false;
  CompactDistributions rows_;
  std::array<Kind, kPlaceKinds> kinds_;
};

}  // namespace turbid
