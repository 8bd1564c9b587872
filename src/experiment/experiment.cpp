#include "experiment/experiment.h"

#include <cctype>

namespace turbid {

double Experiment::declared_seconds(double time_scale) const {
  if (program) return time_scale < 1 && !program->shorter.empty() ? program->shorter_seconds : program->seconds;
  double seconds = 0;
  for (const ExperimentScene& scene : scenes)
    seconds += scene.reference.seconds + rule.seconds * seeds * static_cast<double>(methods.size());
  return seconds * time_scale;
}

SceneChoice choice_of(const ExperimentScene& scene, const std::string& integrator, const std::string& size) {
  return {.file = scene.file,
          .definitions = scene.definitions,
          .integrator = integrator,
          .size = size.empty() ? scene.size : size};
}

std::string file_name(const std::string& name) {
  std::string result;
  for (const char c : name) {
    const auto letter = static_cast<unsigned char>(c);
    if (std::isalnum(letter) || c == '.' || c == '_')
      result += static_cast<char>(std::tolower(letter));
    else if (!result.empty() && result.back() != '-')
      result += '-';
  }
  while (result.ends_with('-')) result.pop_back();
  return result.empty() ? "_" : result;
}

}  // namespace turbid
