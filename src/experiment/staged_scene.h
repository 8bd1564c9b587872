#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "integrator/integrators.h"
#include "render/scene_choice.h"

namespace turbid {

/// A scene with the integrator that is to render it, ready for renders that each begin from nothing.
class StagedScene {
 public:
  const SceneChoice& choice() const { return choice_; }
  const Scene& scene() const { return loaded_->scene; }
  /// Every file that the scene was read from.
  const std::vector<std::filesystem::path>& files() const { return loaded_->files; }
  /// Names all that a render depends on.
  uint64_t fingerprint(uint64_t seed) const { return scene_fingerprint(choice_, files(), seed); }

  IntegratorSetup make() const { return make_integrator(description_, document_.get()); }
  std::string describe() const { return describe_integrator(*description_.node); }
  /// What the integrator cannot find in this scene, in sentences.
  std::vector<std::string> shortcomings() const;

 private:
  friend class Stages;
  struct Loaded {
    Scene scene;
    std::vector<std::filesystem::path> files;
  };

  SceneChoice choice_;
  IntegratorDescription description_;
  std::shared_ptr<const SceneDocument> document_;
  std::shared_ptr<const Loaded> loaded_;
};

/// Stages one scene for several integrators: it is loaded once for all that agree about the unit of length.
class Stages {
 public:
  /// Throws SceneError, FileError, UsageError. Choices must differ in their integrators only.
  StagedScene stage(SceneChoice choice);

 private:
  std::map<double, std::shared_ptr<const StagedScene::Loaded>> by_unit_;
};

}  // namespace turbid
