#pragma once
#include "core/transform.h"
#include "scene/element.h"

namespace turbid {

/// True for <translate>, <rotate>, <scale>, <lookat>, <matrix>.
bool is_transform_operation(const std::string& tag);

/// What one of these tags does. The operations in a <transform> apply in the order in which they are written.
Transform read_transform_operation(const Element& element);

}  // namespace turbid
