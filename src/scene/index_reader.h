#pragma once
#include "scene/properties.h"

namespace turbid {

/// A kIor parameter: an index of refraction, as a number or as the name of a material.
float index_of(const Properties& p, const std::string& name);

}  // namespace turbid
