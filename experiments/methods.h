#pragma once
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "image/image.h"
#include "integrator/integrator.h"
#include "scene/loader.h"

namespace turbid::experiments {

/// What an experiment's program does; `main` reports its exceptions. Returns the exit code.
int run(int argc, char** argv);

/// Scene parameters from texts "name=value".
Overrides overrides(const std::vector<std::string>& definitions);

/// A scene that several integrators render, in this process.
class Stage {
 public:
  /// `definitions`: "name=value", parameters of the scene.
  Stage(const std::string& file, const std::vector<std::string>& definitions);

  /// `integrator` as on the command line ("ptracer,camera_connection=mis").
  std::shared_ptr<Integrator> make(const std::string& integrator) const;
  const Scene& scene() const { return scene_; }

  struct Shot {
    Image image;
    double seconds = 0;  ///< processor time of all threads
    Counters counters;
  };
  Shot render(const std::string& integrator, uint32_t samples, uint64_t seed) const;

 private:
  LoadedScene loaded_;
  Scene scene_;
};

/// A method's error over several seeds.
struct Noise {
  double rmse = 0;      ///< median over the seeds
  double relative = 0;  ///< rmse over the mean of the reference
  double seconds = 0;   ///< processor time of one render, median
  /// RMSE^2 x time.
  double cost() const { return rmse * rmse * seconds; }
};
Noise measure_noise(const Stage& stage, const std::string& integrator, uint32_t samples, const Image& reference,
                    int seeds = 5);

template <class Value>
Value median(std::vector<Value> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// The mean of an image's colours.
double mean_of(const Image& image);

}  // namespace turbid::experiments
