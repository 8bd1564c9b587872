#include "manylight/light_sampler.h"

#include <algorithm>

namespace turbid {
namespace {

class UniformChooser final : public LightSampler::Chooser {
 public:
  explicit UniformChooser(size_t lights) : lights_(lights) {}
  void move_to(const Scatterer&) override {}
  std::optional<LightChoice> sample(double u) const override {
    if (lights_ == 0) return std::nullopt;
    return LightChoice{std::min(static_cast<size_t>(u * static_cast<double>(lights_)), lights_ - 1), prob(0)};
  }
  double prob(size_t) const override { return 1 / static_cast<double>(lights_); }

 private:
  size_t lights_;
};

class UnshadowedChooser final : public LightSampler::Chooser {
 public:
  UnshadowedChooser(const VirtualLights& lights, const LineSettings& lines) : lights_(lights), lines_(lines) {}
  void move_to(const Scatterer& place) override {
    sums_.clear();
    for (const Scatterer& light : lights_.points())
      sums_.add(static_cast<double>(unshadowed(place, light, lines_).mean()));
  }
  std::optional<LightChoice> sample(double u) const override { return sums_.sample(u); }
  double prob(size_t light) const override { return sums_.prob(light); }

 private:
  const VirtualLights& lights_;
  const LineSettings& lines_;
  LightSums sums_;
};

/// Lights whose strength is 0 bring nothing anywhere.
class PowerChooser final : public LightSampler::Chooser {
 public:
  explicit PowerChooser(const LightSums& sums) : sums_(sums) {}
  void move_to(const Scatterer&) override {}
  std::optional<LightChoice> sample(double u) const override { return sums_.sample(u); }
  double prob(size_t light) const override { return sums_.prob(light); }

 private:
  const LightSums& sums_;
};

}  // namespace

// Sorted: lights that stand side by side, and the memory that tells of them, are asked for in turn.
void LightSampler::Chooser::draw(int n, Rng rng, std::vector<Draw>& draws) const {
  draws.clear();
  for (int i = 0; i < n; ++i)
    if (const auto choice = sample_light((i + rng.next_double()) / n))
      draws.push_back({static_cast<uint32_t>(choice->light), 1, choice->prob});
  std::sort(draws.begin(), draws.end(), [](const Draw& a, const Draw& b) { return a.light < b.light; });
  size_t kept = 0;
  for (size_t i = 0; i < draws.size(); ++i) {
    if (kept > 0 && draws[kept - 1].light == draws[i].light)
      ++draws[kept - 1].times;
    else
      draws[kept++] = draws[i];
  }
  draws.resize(kept);
  if (!knows_prob_when_drawn())
    for (Draw& draw : draws) draw.prob = prob(draw.light);
}

PowerLightSampler::PowerLightSampler(const VirtualLights& lights) {
  for (const Scatterer& light : lights.points()) sums_.add(static_cast<double>(light.strength()));
}

std::unique_ptr<LightSampler::Chooser> UniformLightSampler::make_chooser() const {
  return std::make_unique<UniformChooser>(lights_);
}
std::unique_ptr<LightSampler::Chooser> PowerLightSampler::make_chooser() const {
  return std::make_unique<PowerChooser>(sums_);
}
std::unique_ptr<LightSampler::Chooser> UnshadowedLightSampler::make_chooser() const {
  return std::make_unique<UnshadowedChooser>(lights_, lines_);
}

}  // namespace turbid
