#pragma once
#include <memory>

#include "integrator/integrator_plugin.h"
#include "scene/loader.h"

namespace turbid {

/// The integrators, as the table that `turbid list integrators` shows. Each brings its row from its own file.
const IntegratorTable& integrator_table();

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
