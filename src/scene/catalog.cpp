#include "scene/catalog.h"

#include "scene/tables.h"

namespace turbid {

std::vector<CategoryDescription> plugin_catalog() {
  return {describe_table(shape_table(), "shapes"),     describe_table(bsdf_table(), "bsdfs"),
          describe_table(texture_table(), "textures"), describe_table(volume_table(), "volumes"),
          describe_table(emitter_table(), "emitters"), describe_table(medium_table(), "media"),
          describe_table(phase_table(), "phases"),     describe_table(sensor_table(), "sensors"),
          describe_table(film_table(), "films"),       describe_table(sampler_table(), "samplers"),
          describe_table(filter_table(), "rfilters")};
}

}  // namespace turbid
