#include "scene/parameter.h"

#include <fmt/format.h>

namespace turbid {

const char* to_string(ParameterType type) {
  switch (type) {
    case ParameterType::kBoolean:
      return "boolean";
    case ParameterType::kInteger:
      return "integer";
    case ParameterType::kFloat:
      return "float";
    case ParameterType::kString:
      return "string";
    case ParameterType::kFile:
      return "file";
    case ParameterType::kPoint:
      return "point";
    case ParameterType::kVector:
      return "vector";
    case ParameterType::kSpectrum:
      return "spectrum";
    case ParameterType::kTexture:
      return "texture";
    case ParameterType::kIor:
      return "float or material";
    case ParameterType::kTransform:
      return "transform";
    case ParameterType::kFloatOrString:
      return "float or string";
    case ParameterType::kFloatOrVector:
      return "float or vector";
    case ParameterType::kBsdf:
      return "bsdf";
    case ParameterType::kEmitter:
      return "emitter";
    case ParameterType::kMedium:
      return "medium";
    case ParameterType::kPhase:
      return "phase";
    case ParameterType::kFilm:
      return "film";
    case ParameterType::kSampler:
      return "sampler";
    case ParameterType::kFilter:
      return "rfilter";
    case ParameterType::kIntegrator:
      return "integrator";
    case ParameterType::kShape:
      return "shape";
  }
  return "?";
}

bool is_plugin(ParameterType type) { return type >= ParameterType::kBsdf; }

std::string Range::describe() const {
  const bool has_min = std::isfinite(min), has_max = std::isfinite(max);
  if (has_min && has_max) return fmt::format("in {}{}, {}{}", open_min ? '(' : '[', min, max, open_max ? ')' : ']');
  if (has_min) return open_min ? fmt::format("above {}", min) : fmt::format("at least {}", min);
  if (has_max) return open_max ? fmt::format("below {}", max) : fmt::format("at most {}", max);
  return "finite";
}

}  // namespace turbid
