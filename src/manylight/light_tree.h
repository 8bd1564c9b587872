#pragma once
#include "manylight/light_sampler.h"

namespace turbid {

/// A tree of virtual lights with stochastic descent, the usual alternative to caches (Estevez & Kulla 2018): a node
/// knows a box and the strength of its lights; at a place a child is chosen in proportion to strength over squared
/// distance, with bounds on the cosine at diffuse places. Shadows are unknown to it.
class LightTree final : public LightSampler {
 public:
  explicit LightTree(const VirtualLights& lights);
  std::unique_ptr<Chooser> make_chooser() const override;

 private:
  class Descent;
  struct Node {
    Bounds3 box{};
    float strength = 0;
    uint32_t second = 0;  ///< of the children, the first follows its parent; 0: a leaf
    uint32_t light = 0;   ///< of leaves
    uint32_t parent = 0;
  };
  uint32_t build(const std::vector<Scatterer>& lights, std::span<uint32_t> range, uint32_t parent);

  std::vector<Node> nodes_;
  std::vector<uint32_t> leaf_of_;  ///< by light
};

}  // namespace turbid
