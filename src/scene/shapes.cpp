// Shapes: geometry alone. What they are made of (bsdf, media, emitter) belongs to every shape, see loader.cpp.
#include <fmt/format.h>

#include <set>

#include "geometry/basic_meshes.h"
#include "geometry/cylinder.h"
#include "geometry/disk.h"
#include "geometry/generated.h"
#include "geometry/mesh_file.h"
#include "geometry/sdf_grid.h"
#include "geometry/sphere.h"
#include "geometry/triangle_mesh.h"
#include "scene/builder.h"
#include "scene/values.h"
#include "texture/vol_file.h"

namespace turbid {
namespace {

using ShapePtr = std::shared_ptr<const Shape>;
using ShapeTable = PluginTable<ShapePtr, Builder>;
using enum ParameterType;
using Parameters = std::vector<Parameter>;

/// What every shape takes beside its own parameters.
Parameters with_common(Parameters own) {
  const Parameters common = {{"to_world", kTransform, "identity", "from the shape's space"},
                             {"flip_normals", kBoolean, "false", "turn the outside in"},
                             {"bsdf", kBsdf, kOptional, "left out: diffuse 0.5, or black when the shape shines"},
                             {"emitter", kEmitter, kOptional, "of type area: the shape shines"},
                             {"interior", kMedium, kOptional, "medium inside"},
                             {"exterior", kMedium, kOptional, "medium outside"},
                             kPriority};
  own.insert(own.end(), common.begin(), common.end());
  return own;
}

ShapePtr make_sdf_grid(const Properties& p, Builder& b) {
  const VolFile file = read_vol(b.file(p, "filename"));
  const Voxel& size = file.voxels.size();
  if (file.voxels.channels() != 1)
    p.refuse("filename", fmt::format("an sdfgrid takes a grid of 1 channel, found {}", file.voxels.channels()));
  SdfSamples samples{{size.x, size.y, size.z}, {}};
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x) samples.values.push_back(file.voxels.at(x, y, z)[0]);
  const auto normals = p.string("normals") == "smooth" ? SdfGrid::Normals::kSmooth : SdfGrid::Normals::kAnalytic;
  return std::make_shared<SdfGrid>(std::move(samples), normals, p.transform("to_world"), p.boolean("flip_normals"));
}

/// Containers are opened by ShapeTree before anything is made.
ShapePtr make_container(const Properties& p, Builder&) {
  throw std::logic_error(p.node().describe() + " is a container");
}

Parameters mesh_file(const char* flip_tex_coords) {
  return with_common({{"filename", kFile, kRequired, "the mesh"},
                      {"face_normals", kBoolean, "false", "facets: no vertex normals"},
                      {"flip_tex_coords", kBoolean, flip_tex_coords, "v becomes 1 - v"}});
}

template <MeshData (*Load)(const std::filesystem::path&, const MeshFileOptions&)>
ShapePtr make_from_file(const Properties& p, Builder& b) {
  const MeshFileOptions options{p.transform("to_world"), p.boolean("face_normals"), p.boolean("flip_tex_coords")};
  return std::make_shared<TriangleMesh>(Load(b.file(p, "filename"), options), p.boolean("flip_normals"));
}

template <MeshData (*Make)(const Transform&)>
ShapePtr make_basic_mesh(const Properties& p, Builder&) {
  return std::make_shared<TriangleMesh>(Make(p.transform("to_world")), p.boolean("flip_normals"));
}

/// The numbers of all kinds of generated shapes together.
Parameters generated_parameters() {
  Parameter kind{"kind", kString, kRequired, "which generator"};
  Parameters result;
  std::set<std::string> known;
  for (const GeneratedShapeKind& generator : generated_shape_kinds()) {
    kind.choices.push_back(generator.name);
    for (const GeneratedShapeParameter& number : generator.parameters)
      if (known.insert(number.name).second)
        result.push_back({number.name, kFloat, kOptional, number.meaning + " (" + generator.name + " ...)"});
  }
  result.insert(result.begin(), kind);
  result.push_back({"points", kString, kOptional, "the numbers of a profile or curve"});
  result.push_back({"face_normals", kBoolean, "false", "facets: no vertex normals"});
  return with_common(result);
}

ShapePtr make_generated_shape(const Properties& p, Builder&) {
  GeneratedShapeArguments arguments;
  for (const NamedValue& value : p.node().values)
    if (std::holds_alternative<double>(value.value) || std::holds_alternative<int64_t>(value.value))
      arguments.numbers[value.name] = static_cast<double>(p.number(value.name));
  if (p.has("points")) arguments.points = read_numbers(p.string("points"), p.where("points"));
  MeshData mesh = make_generated(p.string("kind"), std::move(arguments));
  if (p.boolean("face_normals")) mesh.normals.clear();
  transform_mesh(mesh, p.transform("to_world"));
  return std::make_shared<TriangleMesh>(std::move(mesh), p.boolean("flip_normals"));
}

}  // namespace

const ShapeTable& shape_table() {
  static const ShapeTable table(
      Category::kShape,
      {{.name = "obj",
        .summary = "A triangle mesh from a Wavefront OBJ file.",
        .parameters = mesh_file("true"),
        .make = make_from_file<load_obj>},
       {.name = "ply",
        .summary = "A triangle mesh from a PLY file, ascii or binary.",
        .parameters = mesh_file("false"),
        .make = make_from_file<load_ply>},
       {.name = "serialized",
        .summary = "A triangle mesh from a file of Mitsuba's compressed format.",
        .parameters = with_common({{"filename", kFile, kRequired, "version 3 or 4"},
                                   {"shape_index", kInteger, "0", "which of its meshes, from 0", kNonNegative},
                                   {"face_normals", kBoolean, "false", "facets: no vertex normals"}}),
        .make =
            [](const Properties& p, Builder& b) {
              const MeshFileOptions options{p.transform("to_world"), p.boolean("face_normals")};
              return std::make_shared<TriangleMesh>(
                  load_serialized(b.file(p, "filename"), p.integer("shape_index"), options), p.boolean("flip_normals"));
            }},
       {.name = "sphere",
        .summary = "A sphere.",
        .parameters = with_common({{"center", kPoint, "0, 0, 0", "middle, in the shape's space"},
                                   {"radius", kFloat, "1", "in the shape's space", kPositive}}),
        .make =
            [](const Properties& p, Builder&) {
              return std::make_shared<Sphere>(p.vector("center"), p.number("radius"), p.transform("to_world"),
                                              p.boolean("flip_normals"));
            }},
       {.name = "rectangle",
        .summary = "[-1, 1] x [-1, 1] in the xy plane, normal +z.",
        .parameters = with_common({}),
        .make = make_basic_mesh<make_rectangle>},
       {.name = "cube",
        .summary = "[-1, 1] in x, y and z.",
        .parameters = with_common({}),
        .make = make_basic_mesh<make_cube>},
       {.name = "disk",
        .summary = "The unit disk in the xy plane, normal +z.",
        .parameters = with_common({}),
        .make = [](const Properties& p,
                   Builder&) { return std::make_shared<Disk>(p.transform("to_world"), p.boolean("flip_normals")); }},
       {.name = "cylinder",
        .summary = "An open tube.",
        .parameters = with_common({{"p0", kPoint, "0, 0, 0", "one end of the axis"},
                                   {"p1", kPoint, "0, 0, 1", "the other end"},
                                   {"radius", kFloat, "1", "of the tube", kPositive}}),
        .make =
            [](const Properties& p, Builder&) {
              return std::make_shared<Cylinder>(p.vector("p0"), p.vector("p1"), p.number("radius"),
                                                p.transform("to_world"), p.boolean("flip_normals"));
            }},
       {.name = "generated",
        .summary = "A triangle mesh made by a generator.",
        .parameters = generated_parameters(),
        .make = make_generated_shape},
       {.name = "sdfgrid",
        .summary = "The surface where samples of a signed distance on the unit cube, interpolated, are 0.",
        .parameters = with_common({{"filename", kFile, kRequired, "a Mitsuba .vol file of 1 channel, negative inside"},
                                   {.name = "normals",
                                    .type = kString,
                                    .default_text = "smooth",
                                    .meaning = "of shading: blended over cells, or as the surface is",
                                    .choices = {"smooth", "analytic"}}}),
        .make = make_sdf_grid},
       {.name = "shapegroup",
        .summary = "Shapes that are seen through instances only, and held in memory once.",
        .parameters = {{"shapes", kShape, kOptional, "any number of shapes that do not shine; names do not matter"}},
        .make = make_container},
       {.name = "instance",
        .summary = "All shapes of a group, with their materials and media, in another place.",
        .parameters = {{"shapegroup", kShape, kRequired, "the group"},
                       {"to_world", kTransform, "identity", "from the group's space; any affine map"}},
        .make = make_container},
       {.name = "merge",
        .summary = "Shapes, as if they stood outside.",
        .parameters = {{"shapes", kShape, kOptional, "any number of shapes; names do not matter"}},
        .make = make_container}},
      {"bsplinecurve", "linearcurve", "ellipsoids", "ellipsoidsmesh", "blender"});
  return table;
}

}  // namespace turbid
