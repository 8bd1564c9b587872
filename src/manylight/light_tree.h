#pragma once
#include "manylight/light_sampler.h"

namespace turbid {

/// A tree of virtual lights with stochastic descent, the usual alternative to caches (Estevez & Kulla 2018): a node
/// knows a box, the strength of its lights and a cone of their normals; at a place a child is chosen in proportion to
/// strength over squared distance (clamped as the lines are), with bounds on the cosines at diffuse places and lights.
/// Shadows are unknown to it.
class LightTree final : public LightSampler {
 public:
  LightTree(const VirtualLights& lights, const LineSettings& lines);
  std::unique_ptr<Chooser> make_chooser() const override;

 private:
  class Descent;
  struct Node {
    Bounds3 box{};
    float strength = 0;
    Vec3 axis{0};         ///< of a cone that holds the normals ...
    float angle = kPi;    ///< ... half of its opening; pi: some light scatters to all sides
    uint32_t second = 0;  ///< of the children, the first follows its parent; 0: a leaf
    uint32_t light = 0;   ///< of leaves
    uint32_t parent = 0;
  };
  static void find_cone(const std::vector<Scatterer>& lights, std::span<const uint32_t> range, Node& node);
  uint32_t build(const std::vector<Scatterer>& lights, std::span<uint32_t> range, uint32_t parent);

  float clamp_distance_;
  std::vector<Node> nodes_;
  std::vector<uint32_t> leaf_of_;  ///< by light
};

}  // namespace turbid
