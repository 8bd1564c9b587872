#include "scene/fov_reader.h"

#include "scene/values.h"
#include "sensor/field_of_view.h"

namespace turbid {
namespace {

FovAxis axis_of(const std::string& name) {
  if (name == "y") return FovAxis::kY;
  if (name == "diagonal") return FovAxis::kDiagonal;
  if (name == "smaller") return FovAxis::kSmaller;
  return name == "larger" ? FovAxis::kLarger : FovAxis::kX;
}

}  // namespace

const std::vector<Parameter>& field_of_view_parameters() {
  using enum ParameterType;
  static const std::vector<Parameter> parameters = {
      {"fov", kFloat, kOptional, "field of view, degrees", {.min = 0, .max = 180, .open_min = true, .open_max = true}},
      {.name = "fov_axis",
       .type = kString,
       .default_text = "x",
       .meaning = "of the film, along which fov is measured",
       .choices = {"x", "y", "diagonal", "smaller", "larger"}},
      {"focal_length", kString, "50mm", "instead of fov: before 35 mm film"}};
  return parameters;
}

double read_horizontal_fov(const Properties& p, double aspect) {
  if (p.has("fov")) {
    if (p.has("focal_length")) p.refuse("focal_length", "cannot stand beside 'fov'");
    return horizontal_fov(static_cast<double>(p.number("fov")), axis_of(p.string("fov_axis")), aspect);
  }
  std::string length = p.string("focal_length");
  if (length.ends_with("mm")) length.resize(length.size() - 2);
  const double millimetres = read_number(length, p.where("focal_length"));
  if (!(millimetres > 0)) p.refuse("focal_length", "must be above 0");
  return horizontal_fov(diagonal_fov_of_focal_length(millimetres), FovAxis::kDiagonal, aspect);
}

}  // namespace turbid
