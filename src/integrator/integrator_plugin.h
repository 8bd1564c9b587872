#pragma once
#include <memory>

#include "integrator/integrator.h"
#include "path/connection_sampler.h"
#include "path/path_settings.h"
#include "scene/plugin.h"

namespace turbid {

/// An integrator as a scene file asks for it, wrappers resolved.
struct IntegratorSetup {
  std::shared_ptr<Integrator> integrator;
  bool second_moment = false;  ///< a `moment` wrapper: write the mean square of the samples too
};

using IntegratorTable = PluginTable<IntegratorSetup>;
using IntegratorPlugin = Plugin<IntegratorSetup>;

/// The parameters that all image integrators understand, followed by an integrator's own. `max_depth`: the default.
std::vector<Parameter> with_common_parameters(std::vector<Parameter> own, const std::string& max_depth = "-1");

/// What the common parameters say. Throws SceneError.
PathSettings path_settings(const Properties& properties);

/// A parameter that is one of some words; `value`: the default.
Parameter word(const std::string& name, const std::string& value, const std::string& meaning,
               std::vector<std::string> choices);

/// How collisions next to the other end of a path are found: the parameters `name` and `sampling`. `end`: what stands
/// there, in words.
std::vector<Parameter> connection_parameters(const std::string& name, const std::string& end);
ConnectionSettings connection_settings(const Properties& properties, const std::string& name);

}  // namespace turbid
