#pragma once
#include <algorithm>
#include <memory>
#include <optional>

#include "manylight/virtual_lights.h"

namespace turbid {

/// A virtual light chosen among all, and the probability of that.
struct LightChoice {
  size_t light;
  double prob;
};

/// Partial sums of weights, in double: the probability of a light is exactly the width of its interval.
class LightSums {
 public:
  void clear() { ends_.clear(); }
  void add(double weight) {
    const double begin = ends_.empty() ? 0 : ends_.back();
    // However small a weight is, it keeps an interval.
    const double end = begin + weight > begin || weight == 0
                           ? begin + weight
                           : std::nextafter(begin, std::numeric_limits<double>::infinity());
    ends_.push_back(end);
  }
  std::optional<LightChoice> sample(double u) const {
    if (ends_.empty() || !(ends_.back() > 0)) return std::nullopt;
    const auto end = std::upper_bound(ends_.begin(), ends_.end(), u * ends_.back());
    auto light = static_cast<size_t>(std::min(end, ends_.end() - 1) - ends_.begin());
    while (light > 0 && ends_[light] == ends_[light - 1]) --light;
    return LightChoice{light, prob(light)};
  }
  double prob(size_t light) const { return (ends_[light] - (light > 0 ? ends_[light - 1] : 0)) / ends_.back(); }

 private:
  std::vector<double> ends_;
};

/// Chooses among the virtual lights of one set for places that are shaded. Every light that brings something to a place
/// has a probability above 0 there, so that value / prob is an unbiased estimate of the sum over all lights.
class LightSampler {
 public:
  virtual ~LightSampler() = default;

  /// The choice at one place after another, by one thread.
  class Chooser {
   public:
    virtual ~Chooser() = default;
    /// The place stays where it is until the next one.
    virtual void move_to(const Scatterer& place) = 0;
    /// The same for a whole way of the sensor's walk. Unless said otherwise the choice is the same everywhere.
    virtual void move_along(const Ray& /*way*/) {}
    /// Takes a number in [0, 1). Empty where no light can bring anything.
    virtual std::optional<LightChoice> sample(double u) const = 0;
    /// The probability with which sample() returns this light.
    virtual double prob(size_t light) const = 0;

    /// A light that was drawn, and how often.
    struct Draw {
      uint32_t light, times;
      double prob;
    };
    /// Draws n times, from n strata, into `draws`: every light that was drawn once, in the order of the lights.
    void draw(int n, Rng rng, std::vector<Draw>& draws) const;

   protected:
    /// As sample(), where the probability is asked for later; `draws` holds it not yet then.
    virtual std::optional<LightChoice> sample_light(double u) const { return sample(u); }
    virtual bool knows_prob_when_drawn() const { return true; }
  };
  virtual std::unique_ptr<Chooser> make_chooser() const = 0;
};

/// All lights alike.
class UniformLightSampler final : public LightSampler {
 public:
  explicit UniformLightSampler(size_t lights) : lights_(lights) {}
  std::unique_ptr<Chooser> make_chooser() const override;

 private:
  size_t lights_;
};

/// In proportion to the lights' strength, wherever they stand.
class PowerLightSampler final : public LightSampler {
 public:
  explicit PowerLightSampler(const VirtualLights& lights);
  std::unique_ptr<Chooser> make_chooser() const override;

 private:
  LightSums sums_;
};

/// In proportion to what each light would bring if nothing stood between (L f G of S2 sect. 5): asks all lights at each
/// place.
class UnshadowedLightSampler final : public LightSampler {
 public:
  UnshadowedLightSampler(const VirtualLights& lights, const LineSettings& lines) : lights_(lights), lines_(lines) {}
  std::unique_ptr<Chooser> make_chooser() const override;

 private:
  const VirtualLights& lights_;
  LineSettings lines_;
};

}  // namespace turbid
