#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace turbid {

/// Cells around a source that shines along +z, in cylindrical coordinates: the distance `rho` from its axis and `z`
/// along it, mean free paths. A square of `reach` x `reach` ahead of the source, and half of one behind it, cut into
/// quarters where much light is (S1 sect. 4.1).
class Quadtree {
 public:
  struct Place {
    float rho, z;
  };
  /// A cell that is not cut any more.
  struct Leaf {
    int number;
    float rho, z;  ///< of its corner next to the axis and farthest behind
    float size;    ///< of its sides
  };
  /// When cutting ends.
  struct Limits {
    size_t leaves = 3000;        ///< no more of them
    double share = 2e-4;         ///< of all places that a cell holds that is not cut
    double rare_share = 1.5e-5;  ///< the same for cells larger than 1/32 of the reach
    int halvings = 9;            ///< of the reach
  };

  /// Cuts the cell that holds most of the places, again and again.
  Quadtree(float reach, std::span<const Place> places, const Limits& limits);
  /// From what nodes() gave. Throws std::invalid_argument when they are no tree.
  Quadtree(float reach, std::vector<int32_t> nodes);

  float reach() const { return reach_; }
  /// Behind the source it ends there.
  float behind() const { return -reach_ / 2; }
  size_t leaf_count() const { return leaf_count_; }
  /// Per node the number of its first child (of four: lower rho and z, higher rho, higher z, both), or -1 - the number
  /// of the leaf; the roots first.
  const std::vector<int32_t>& nodes() const { return nodes_; }

  bool holds(const Place& place) const {
    return place.rho >= 0 && place.rho < reach_ && place.z >= behind() && place.z < reach_;
  }
  /// The leaf at a place that it holds.
  Leaf find(const Place& place) const;
  /// All leaves, by number.
  std::vector<Leaf> leaves() const;
  /// Of the ring that a leaf stands for, in cubic mean free paths.
  static double volume(const Leaf& leaf);

 private:
  /// Half the reach wide: two across, three along.
  static constexpr int kRootsAcross = 2, kRootsAlong = 3;
  void collect(size_t node, const Leaf& square, std::vector<Leaf>& result) const;
  Leaf root(int number) const;
  static Leaf quarter(const Leaf& square, int which);

  float reach_;
  size_t leaf_count_ = 0;
  std::vector<int32_t> nodes_;
};

}  // namespace turbid
