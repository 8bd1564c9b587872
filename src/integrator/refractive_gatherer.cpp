#include "integrator/refractive_gatherer.h"

namespace turbid {

Parameter single_scattering_parameter() {
  return word("single_scattering", "path",
              "light that one smooth boundary of triangles bends before it scatters once: found by paths, or as "
              "singlescatter finds it",
              {"path", "refractive"});
}

std::optional<RefractiveSettings> refraction_settings(const Properties& properties) {
  if (properties.string("single_scattering") != "refractive") return std::nullopt;
  return RefractiveSettings{};
}

}  // namespace turbid
