#pragma once
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "experiment/experiment_file.h"
#include "testing/temporary_folder.h"

namespace turbid::testing {

/// A ball of fog under a white sky.
inline constexpr const char* kFogScene = R"(<scene version="3.0.0">
  <default name="density" value="1"/>
  <integrator type="volpath"><integer name="max_depth" value="8"/></integrator>
  <sensor type="perspective">
    <float name="fov" value="40"/>
    <transform name="to_world"><lookat origin="0, 1, 5" target="0, 0, 0" up="0, 1, 0"/></transform>
    <film type="hdrfilm"><integer name="width" value="12"/><integer name="height" value="10"/></film>
  </sensor>
  <emitter type="constant"><rgb name="radiance" value="1, 0.8, 0.5"/></emitter>
  <shape type="sphere">
    <bsdf type="null"/>
    <medium name="interior" type="homogeneous">
      <float name="sigma_t" value="$density"/>
      <rgb name="albedo" value="0.9, 0.8, 0.7"/>
    </medium>
  </shape>
</scene>
)";

/// Two methods on a small scene at equal samples, as JSON to be changed and written.
inline nlohmann::ordered_json small_experiment() {
  return nlohmann::ordered_json::parse(R"({
    "title": "Two kinds of paths", "figure": "S9 Fig. 1",
    "compare": {"by": "equal samples", "samples": 8, "seconds": 60},
    "seeds": 3, "points": 3,
    "reference": {"integrator": "volpath", "seconds": 0.2},
    "scenes": [{"name": "fog", "file": "fog.xml", "define": {"density": 2}}],
    "methods": [{"name": "paths", "integrator": "volpath"}, {"name": "Light tracing!", "integrator": "ptracer"}],
    "published": [{"scene": "fog", "method": "Light tracing!", "over": "paths", "measure": "rmse", "value": 2}]
  })");
}

/// A folder with a scene and an experiment.
class ExperimentFolder {
 public:
  explicit ExperimentFolder(const nlohmann::ordered_json& experiment = small_experiment()) {
    std::ofstream(folder_.file("fog.xml")) << kFogScene;
    write(experiment);
  }
  void write(const nlohmann::ordered_json& experiment) const { std::ofstream(path()) << experiment.dump(1); }
  void write(const std::string& text) const { std::ofstream(path()) << text; }

  std::string path() const { return folder_.file("small.json"); }
  std::string file(const std::string& name) const { return folder_.file(name); }
  Experiment read() const { return read_experiment(path()); }

 private:
  TemporaryFolder folder_;
};

}  // namespace turbid::testing
