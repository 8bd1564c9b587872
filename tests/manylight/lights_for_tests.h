#pragma once
#include <string>

#include "manylight/virtual_lights.h"
#include "path/walk.h"
#include "scene/loader.h"

namespace turbid::testing {

/// A box of fog with a lamp and a glossy and a diffuse wall, and the virtual lights of some paths in it.
class FoggyBox {
 public:
  explicit FoggyBox(size_t paths = 40)
      : loaded_(load_scene_from_string(R"(<scene version="3.0.0"><sensor type="perspective"/>
    <shape type="cube"><transform name="to_world"><scale value="2"/></transform>
      <bsdf type="twosided"><bsdf type="diffuse"><rgb name="reflectance" value="0.6, 0.5, 0.4"/></bsdf></bsdf>
      <medium name="interior" type="homogeneous"><rgb name="sigma_t" value="0.2, 0.4, 0.6"/>
        <rgb name="albedo" value="0.9"/><phase type="hg"><float name="g" value="0.5"/></phase></medium></shape>
    <shape type="sphere"><point name="center" value="0.9, -0.8, 0.2"/><float name="radius" value="0.5"/>
      <bsdf type="roughconductor"><float name="alpha" value="0.4"/></bsdf></shape>
    <shape type="sphere"><float name="radius" value="0.1"/>
      <emitter type="area"><rgb name="radiance" value="1"/></emitter></shape></scene>)",
                                       "box of fog", {})),
        scene(std::move(loaded_.parts)),
        sources(scene, true),
        lights({scene, sources, settings, 7}, paths, 0, counters) {}

 private:
  LoadedScene loaded_;

 public:
  Scene scene;
  PathSettings settings;
  LightSources sources;
  SampleCounters counters;
  VirtualLights lights;

  /// Vertices of other paths stand for what the sensor sees.
  VirtualLights places() { return VirtualLights({scene, sources, settings, 8}, 10, 1, counters); }
};

}  // namespace turbid::testing
