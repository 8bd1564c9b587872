#pragma once
#include "integrator/integrators.h"

namespace turbid {

/// Which image integrator suits a scene.
struct Advice {
  std::string integrator;
  std::string why;  ///< as to a colleague
};
Advice suggest_integrator(const Scene& scene);

/// Which kinds of paths a scene has: true where an integrator without that support misses light.
PathSupport asked_for(const Scene& scene);

/// What to tell people whose integrator cannot find all of the light that their scene has; by name.
std::vector<std::string> missed_light(const IntegratorDescription& description, const Integrator& integrator,
                                      const Scene& scene);

/// The length of the longest side of the largest object that a medium fills, in scene units; 0 where it fills none.
float extent_of(const Scene& scene, const Medium* medium);

/// What to tell people whose integrator ignores the media that their scene has, by name; else empty.
std::string ignored_media(const IntegratorDescription& description, const Integrator& integrator, const Scene& scene);

/// The name of the innermost integrator, which makes the picture.
std::string image_integrator(const IntegratorDescription& description);

}  // namespace turbid
