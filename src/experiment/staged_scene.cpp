#include "experiment/staged_scene.h"

#include "integrator/advice.h"
#include "scene/scene_loader.h"

namespace turbid {

std::vector<std::string> StagedScene::shortcomings() const {
  const IntegratorSetup setup = make();
  std::vector<std::string> found = missed_light(description_, *setup.integrator, scene());
  if (std::string ignored = ignored_media(description_, *setup.integrator, scene()); !ignored.empty())
    found.push_back(std::move(ignored));
  return found;
}

StagedScene Stages::stage(SceneChoice choice) {
  StagedScene staged;
  SceneDocument document = read_chosen(choice);
  staged.choice_ = std::move(choice);
  staged.description_ = find_integrator(document);
  staged.document_ = std::make_shared<const SceneDocument>(document);
  auto& loaded = by_unit_[find_scene_unit(*staged.description_.node)];
  if (!loaded) {
    LoadedScene read = load_scene(std::move(document));
    loaded = std::make_shared<const StagedScene::Loaded>(
        StagedScene::Loaded{Scene(std::move(read.parts)), std::move(read.files)});
  }
  staged.loaded_ = loaded;
  return staged;
}

}  // namespace turbid
