#pragma once
#include <memory>

#include "integrator/integrator.h"
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

}  // namespace turbid
