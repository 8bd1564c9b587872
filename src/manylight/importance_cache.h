#pragma once
#include <array>
#include <functional>

#include "manylight/compact_distributions.h"
#include "manylight/near_lights.h"

namespace turbid {

/// Places of each kind have cache points of their own: what lights bring to a surface depends on its side, to a whole
/// way on where it leads (S2 Fig. 4).
enum class PlaceKind : uint8_t { kSurface, kCollision, kWay };
inline constexpr size_t kPlaceKinds = 3;

/// What is mixed with the records of the nearest cache points.
struct CacheShares {
  // Of a point's record, from when all are made:
  double group = 0.3;  ///< the mean of the records around it (ImportanceCache::kGroup)
  double all = 0.05;   ///< the mean of all records of its kind
  // At a place; the rest is what the nearest points say:
  double near = 0.1;     ///< NearLights
  double uniform = 0.1;  ///< every light alike: finds what nothing else finds ...
  double glossy = 0.25;  ///< ... and that on glossy surfaces: what they are lit by depends on where they are seen from

  /// S2 sect. 4.2: w_u = sum_m w_m / M, and nothing else.
  static CacheShares seed(size_t nearest) {
    const double uniform = 1 / static_cast<double>(nearest + 1);
    return {0, 0, 0, uniform, uniform};
  }
};

/// What lights bring to places, recorded at some of them and mixed at others from those nearby (S2 sect. 4; for
/// surfaces Georgiev et al. 2012, importance caching).
struct CacheSettings {
  std::array<size_t, kPlaceKinds> points = {1000, 1000, 0};
  size_t nearest = 3;  ///< M, at most ImportanceCache::kMostNearest
  CacheShares shares;
  size_t memory = size_t{512} << 20;  ///< bytes, at most; above, fewer points are recorded
};

/// Chooses virtual lights in proportion to what they bring to cache points nearby, shadows included.
///
/// At a place the M nearest points m have weights w_m that add up to 1; the probability of a light is
///   (1 - near - uniform) sum_m w_m q_m + near p_near + uniform / N
/// where q_m is the record of point m, mixed with the mean of its group and that of all points (CacheShares). It
/// is evaluated in whole for the light that was drawn, whichever part drew it (S2 sect. 4.2, which has the points and
/// uniform choice alone). Points that no light reaches take part as uniform ones.
class ImportanceCache final : public LightSampler {
 public:
  static constexpr size_t kMostNearest = 8;
  static constexpr size_t kGroup = 16;  ///< points in a group, at most

  /// Records one point: fills in what each light brings to it (any scale). `number` names its random numbers.
  struct Record {
    Vec3 position{0};   ///< of ways: where they begin
    Vec3 direction{0};  ///< of surfaces the normal, of ways where they lead; collisions: zero
    bool valid = false;
  };
  using Recorder = std::function<Record(PlaceKind kind, size_t number, std::span<float> weights)>;

  /// Asks `record` for every point, from all threads. `spacing`: by kind, the distance that counts as much as a right
  /// angle between directions. `near` may be null: its share is then uniform choice's.
  ImportanceCache(const CacheSettings& settings, size_t lights, const std::array<float, kPlaceKinds>& spacing,
                  const Recorder& record, std::unique_ptr<NearLights> near = nullptr);

  std::unique_ptr<Chooser> make_chooser() const override;

  size_t points() const;
  size_t bytes() const { return rows_.bytes(); }
  /// Fewer points fit into the memory than were asked for.
  bool is_cut() const { return cut_; }

  /// The points that are mixed at a place, with weights that add up to 1 together with that of uniform choice, which
  /// stands for points without light.
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

  /// Mixes the rows of a kind with the means of their groups and of all.
  void blend(const std::vector<Tree::Point>& places, const std::vector<uint32_t>& rows);

  size_t lights_, nearest_;
  CacheShares shares_;
  bool cut_ = false;
  CompactDistributions rows_;
  std::array<Kind, kPlaceKinds> kinds_;
  std::unique_ptr<NearLights> near_;
};

}  // namespace turbid
