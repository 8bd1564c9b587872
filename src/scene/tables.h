#pragma once
#include "emitter/emitter.h"
#include "geometry/shape.h"
#include "image/filter.h"
#include "medium/medium.h"
#include "scene/plugin.h"
#include "scene/scene.h"
#include "sensor/sensor.h"
#include "surface/bsdf.h"
#include "texture/texture.h"
#include "texture/volume.h"

namespace turbid {

class Builder;

/// What a <sampler> says.
struct SamplerSettings {
  SamplerKind kind = SamplerKind::kIndependent;
  uint32_t sample_count = 4;  ///< Mitsuba's default
};

/// Where an <emitter> stands: in a shape, or (null) in the scene.
struct EmitterPlace {
  std::shared_ptr<const Shape> shape;
};

/// Of shapes and of media: see MediumStack.
inline const Parameter kPriority{"priority", ParameterType::kInteger, kOptional,
                                 "of overlapping shapes with media the highest counts; left out: 0", Range{-1e9, 1e9}};

// One table per category, one file per table. Adding a plugin: its class in its room, and a row here.
const PluginTable<std::shared_ptr<const Shape>, Builder>& shape_table();
const PluginTable<std::shared_ptr<const Bsdf>, Builder>& bsdf_table();
const PluginTable<std::shared_ptr<const Texture>, Builder>& texture_table();
const PluginTable<std::shared_ptr<const Volume>, Builder>& volume_table();
const PluginTable<std::shared_ptr<Emitter>, Builder, const EmitterPlace>& emitter_table();
const PluginTable<std::shared_ptr<const Medium>, Builder>& medium_table();
/// The row of that table which is made of volumes.
Plugin<std::shared_ptr<const Medium>, Builder> heterogeneous_row();
const PluginTable<std::shared_ptr<const PhaseFunction>, Builder>& phase_table();
/// The film has been read already: a sensor's field of view needs its shape.
const PluginTable<std::shared_ptr<const Sensor>, Builder, const FilmSettings>& sensor_table();
const PluginTable<FilmSettings, Builder>& film_table();
const PluginTable<SamplerSettings, Builder>& sampler_table();
const PluginTable<ReconstructionFilter, Builder>& filter_table();

}  // namespace turbid
