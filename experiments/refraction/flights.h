#pragma once
#include "refraction/refractive_scattering.h"
#include "scene/loader.h"

namespace turbid::experiments {

/// The flights of the camera rays of all pixels through the first medium of a scene, from where they are refracted into
/// it: what refractive scattering is asked for, without the rest of a picture.
class Flights {
 public:
  /// `definitions`: "name=value", parameters of the scene.
  Flights(const std::string& file, const std::vector<std::string>& definitions);

  const Scene& scene() const { return scene_; }
  const Medium& medium() const { return *medium_; }
  const std::vector<Ray>& all() const { return flights_; }

  struct Rendering {
    std::vector<double> values;  ///< radiance of each flight
    double seconds = 0;          ///< processor time of one flight
    SampleCounters counters;
  };
  /// One estimate of every flight, or of each `stride`-th; `index` names the random numbers.
  Rendering render(const RefractiveSettings& settings, uint64_t index, size_t stride = 1) const;

  /// In-scattered radiance at distance t along a flight, attenuated by nothing but the way to there: what S4 Fig. 3
  /// plots. Found by Newton's method on each triangle, from `starts` places along each of its sides.
  std::vector<double> radiance_along(const Ray& flight, size_t points, int starts = 1) const;

 private:
  void add(const Ray& ray);

  LoadedScene loaded_;
  Scene scene_;
  std::shared_ptr<const Medium> medium_;
  std::vector<Ray> flights_;
};

double mean_of(const std::vector<double>& values);
double mean_square_difference(const std::vector<double>& a, const std::vector<double>& b);

}  // namespace turbid::experiments
