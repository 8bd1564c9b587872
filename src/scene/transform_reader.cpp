#include "scene/transform_reader.h"

#include <stdexcept>

#include "core/frame.h"
#include "scene/suggestions.h"
#include "scene/values.h"

namespace turbid {
namespace {

const std::vector<std::string> kOperations = {"translate", "rotate", "scale", "lookat", "matrix"};

/// value="..." or any of x, y, z; those left out are `missing`.
Imath::V3d read_components(const Element& element, double missing) {
  const bool parts = element.has("x") || element.has("y") || element.has("z");
  if (element.has("value") && parts) element.refuse("<" + element.tag() + "> takes either 'value' or 'x', 'y', 'z'");
  if (element.has("value")) return read_vector(element.get("value"), element.where("value"));
  if (!parts) element.refuse("<" + element.tag() + "> needs 'value' or any of 'x', 'y', 'z'");
  Imath::V3d v(missing);
  if (element.has("x")) v.x = read_number(element.get("x"), element.where("x"));
  if (element.has("y")) v.y = read_number(element.get("y"), element.where("y"));
  if (element.has("z")) v.z = read_number(element.get("z"), element.where("z"));
  return v;
}

Imath::V3d read_three(const Element& element, const char* attribute) {
  const std::vector<double> v = read_numbers(element.get(attribute), element.where(attribute));
  if (v.size() != 3)
    throw SceneError(element.where(attribute), "expected 3 numbers, found " + std::to_string(v.size()));
  return {v[0], v[1], v[2]};
}

Transform read_look_at(const Element& element) {
  element.check_attributes({"origin", "target"}, {"up"});
  const Imath::V3d origin = read_three(element, "origin"), target = read_three(element, "target");
  Imath::V3d up = element.has("up") ? read_three(element, "up") : Imath::V3d(0);
  if (up == Imath::V3d(0) && origin != target) {  // any direction across the view, as Mitsuba does
    const Imath::V3d view = (target - origin).normalized();
    up = Imath::V3d(Frame(Vec3(view)).s);
  }
  return Transform::look_at(origin, target, up);
}

Transform read_matrix(const Element& element) {
  element.check_attributes({"value"});
  const std::vector<double> v = read_numbers(element.get("value"), element.where("value"));
  if (v.size() != 16 && v.size() != 9)
    throw SceneError(element.where("value"), "expected 16 or 9 numbers, found " + std::to_string(v.size()));
  const size_t n = v.size() == 16 ? 4 : 3;
  double m[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
  for (size_t row = 0; row < n; ++row)
    for (size_t column = 0; column < n; ++column) m[row][column] = v[row * n + column];
  return Transform(m);
}

Transform read_operation(const Element& element) {
  const std::string tag = element.tag();
  if (tag == "lookat") return read_look_at(element);
  if (tag == "matrix") return read_matrix(element);
  if (tag == "rotate") {
    element.check_attributes({"angle"}, {"value", "x", "y", "z"});
    const Imath::V3d axis = read_components(element, 0);
    return Transform::rotate(axis.x, axis.y, axis.z, read_number(element.get("angle"), element.where("angle")));
  }
  element.check_attributes({}, {"value", "x", "y", "z"});
  if (tag == "translate") {
    const Imath::V3d by = read_components(element, 0);
    return Transform::translate(by.x, by.y, by.z);
  }
  const Imath::V3d by = read_components(element, 1);
  return Transform::scale(by.x, by.y, by.z);
}

}  // namespace

bool is_transform_operation(const std::string& tag) {
  return std::find(kOperations.begin(), kOperations.end(), tag) != kOperations.end();
}

Transform read_transform_operation(const Element& element) {
  const std::string tag = element.tag();
  if (!is_transform_operation(tag))
    element.refuse("<" + tag + "> cannot stand inside <transform>" + suggestion(tag, kOperations));
  element.check_empty();
  try {
    return read_operation(element);
  } catch (const std::invalid_argument& error) {
    element.refuse(error.what());
  }
}

}  // namespace turbid
