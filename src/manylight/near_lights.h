#pragma once
#include <array>
#include <span>

#include "manylight/k_d_tree.h"
#include "manylight/virtual_lights.h"

namespace turbid {

/// The point lights nearest to places. 1/d^2 makes one of them bring more than all others together, and not to the
/// cache points around.
class NearLights {
 public:
  static constexpr size_t kCount = 16;

  NearLights(const VirtualLights& lights, const LineSettings& lines);

  /// The choice at one place, in proportion to what each of the nearest lights would bring if nothing stood between.
  class Choice {
   public:
    /// `near` null: nothing is near.
    Choice() = default;
    Choice(const NearLights& near, const Scatterer& place);
    /// None of them would bring anything.
    bool is_empty() const { return count_ == 0; }
    /// Takes a number in [0, 1); only where not empty.
    size_t sample(double u) const {
      size_t i = 0;
      while (i + 1 < count_ && u >= probs_[i]) u -= probs_[i++];
      return lights_[i];
    }
    double prob(size_t light) const {
      size_t found = kCount;
      for (size_t i = 0; i < kCount; ++i) found = lights_[i] == light ? i : found;
      return probs_[found];
    }

   private:
    size_t count_ = 0;
    std::array<uint32_t, kCount> lights_ = filled(~uint32_t{0});
    std::array<double, kCount + 1> probs_{};  ///< the last: of any other light

    static constexpr std::array<uint32_t, kCount> filled(uint32_t light) {
      std::array<uint32_t, kCount> all{};
      all.fill(light);
      return all;
    }
  };

 private:
  using Tree = KdTree<3>;
  const VirtualLights& lights_;
  LineSettings lines_;
  Tree tree_;
};

}  // namespace turbid
