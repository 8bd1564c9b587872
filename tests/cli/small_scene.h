#pragma once
#include <fstream>
#include <string>

namespace turbid::testing {

/// A few spheres under a white sky, quick to render at any number of samples.
inline constexpr const char* kSmallScene = R"(<scene version="3.0.0">
  <default name="res" value="48"/>
  <integrator type="moment">
    <integrator type="volpath" name="inner"><integer name="max_depth" value="6"/></integrator>
  </integrator>
  <sensor type="perspective">
    <float name="fov" value="40"/>
    <transform name="to_world"><lookat origin="0, 1, 5" target="0, 0, 0" up="0, 1, 0"/></transform>
    <sampler type="independent"><integer name="sample_count" value="16"/></sampler>
    <film type="hdrfilm">
      <integer name="width" value="$res"/>
      <integer name="height" value="$res"/>
      <rfilter type="box"/>
    </film>
  </sensor>
  <emitter type="constant"><rgb name="radiance" value="1"/></emitter>
  <shape type="sphere" id="cloud">
    <bsdf type="null"/>
    <medium name="interior" type="homogeneous">
      <rgb name="sigma_t" value="2, 1, 0.5"/>
      <rgb name="albedo" value="0.9, 0.8, 0.7"/>
    </medium>
  </shape>
</scene>
)";

inline std::string write_small_scene(const std::string& path) {
  std::ofstream(path) << kSmallScene;
  return path;
}

}  // namespace turbid::testing
