#pragma once
#include <memory>

#include "integrator/integrator.h"
#include "scene/loader.h"
#include "scene/plugin.h"

namespace turbid {

/// An integrator as a scene file asks for it, wrappers resolved.
struct IntegratorSetup {
  std::shared_ptr<Integrator> integrator;
  bool second_moment = false;  ///< a `moment` wrapper: write the mean square of the samples too
};

/// The integrators, as the table that `turbid list integrators` shows.
const PluginTable<IntegratorSetup>& integrator_table();

/// Makes what the node describes. Throws SceneError.
IntegratorSetup make_integrator(const IntegratorDescription& description, const SceneDocument* document = nullptr);

/// Puts another image integrator ("volpath", with key=value settings) in the place of the innermost one, keeping
/// wrappers. Parameters that the old one was given are carried over where the new one declares them.
struct IntegratorReplacement {
  IntegratorDescription description;
  std::vector<std::string> dropped;  ///< names of the old one's parameters that the new one does not have
};
IntegratorReplacement replace_integrator(const IntegratorDescription& old, const std::string& type,
                                         const std::vector<std::pair<std::string, std::string>>& settings);

}  // namespace turbid
