#include "scene/scene_check.h"

#include <fmt/format.h>

#include <algorithm>

#include "geometry/triangle_mesh.h"

namespace turbid {
namespace {

/// A triangle of this many mean free paths: its rounding errors, which a ray that leaves it must skip, are about
/// kSkippedShare of a mean free path.
constexpr float kCoarseTriangle = 1e4f, kSkippedShare = 0.01f;

class Check {
 public:
  explicit Check(const Scene& scene) : scene_(scene) {}

  std::vector<std::string> run() {
    for (const Object& object : scene_.objects())
      if (object.bounds_media) check_boundary(object);
    check_sensor();
    return std::move(findings_);
  }

 private:
  template <class... Arguments>
  void say(fmt::format_string<Arguments...> text, Arguments&&... arguments) {
    findings_.push_back(fmt::format(text, std::forward<Arguments>(arguments)...));
  }

  void check_boundary(const Object& object) {
    const std::string name = name_of(scene_, object);
    if (!object.shape->is_closed()) {
      if (object.interior)
        say("{} bounds a medium and is not closed: light that goes in and not out again stays in the medium to the end "
            "of the world",
            name);
    } else if (is_inside_out(scene_, object)) {
      say("{} has its normals flipped: its interior medium lies outside of it", name);
    }
    constexpr lobe::Flags kLetsIn = lobe::kTransmission | lobe::kNull;
    if (!(object.bsdf->flags() & kLetsIn))
      say("{} bounds a medium and its bsdf lets no light through: for an invisible boundary use 'null'", name);
    check_triangles(object, name);
  }

  void check_triangles(const Object& object, const std::string& name) {
    float densest = 0;
    for (const Medium* medium : {object.interior.get(), object.exterior.get()})
      if (medium) densest = std::max(densest, medium->max_sigma_t());
    const float paths = longest_edge(*object.shape) * densest;
    if (paths > kCoarseTriangle)
      say("{} has triangles of up to {:.2g} mean free paths of its medium: leaving one skips about {:.1g} % of a mean "
          "free path (finer triangles skip less)",
          name, paths, 100 * kSkippedShare * paths / kCoarseTriangle);
  }

  void check_sensor() {
    if (!scene_.sensor_medium_declared()) return;
    const Medium* declared = scene_.sensor_medium();
    const auto has_it = [&](const Object& o) { return o.interior.get() == declared || o.exterior.get() == declared; };
    if (declared && declared != scene_.world_medium() &&
        std::none_of(scene_.objects().begin(), scene_.objects().end(), has_it))
      say("the sensor stands in a medium that no shape declares: it goes on until a surface that bounds media, or to "
          "the end of the world");
    const Medium* around = scene_.has_priorities() ? declared : scene_.medium_at(scene_.sensor().position());
    if (around && around != declared)
      say("the sensor declares one medium, and the shapes around it say that it stands in another");
  }

  const Scene& scene_;
  std::vector<std::string> findings_;
};

}  // namespace

std::vector<std::string> check_scene(const Scene& scene) { return Check(scene).run(); }

std::string name_of(const Scene& scene, const Object& object) {
  if (!object.id.empty()) return "shape '" + object.id + "'";
  return fmt::format("shape {} (it has no id)", &object - scene.objects().data() + 1);
}

bool is_inside_out(const Scene& scene, const Object& object) {
  // From far outside the first that one sees of a closed shape is its outside. Tried towards several points of its box,
  // as some may be missed (a torus has nothing in the middle).
  const Bounds3 box = object.shape->bounds();
  const auto index = static_cast<uint32_t>(&object - scene.objects().data());
  constexpr int kTries = 16;
  for (int i = 0; i < kTries; ++i) {
    // An additive recurrence fills the box evenly; its first point is the middle.
    const auto fraction = [i](float step) {
      return 0.5f + step * static_cast<float>(i) - std::floor(0.5f + step * static_cast<float>(i));
    };
    const Vec3 at{fraction(0.8191725f), fraction(0.6710436f), fraction(0.5497005f)};
    const Vec3 target = box.min + at * (box.max - box.min);
    const Vec3 from = target + Vec3(0.83f, 0.41f, 0.37f) * (3 * length(box.size()));
    Ray ray{from, normalize(target - from)};
    while (const Hit hit = scene.rays().intersect(ray)) {
      if (hit.shape == index) return leads_outside(hit.ng, ray.direction);
      ray.origin = scene.object(hit).shape->surface_point(ray, hit).leave(ray.direction);
    }
  }
  return false;
}

float longest_edge(const Shape& shape) {
  const auto* mesh = dynamic_cast<const TriangleMesh*>(&shape);
  if (!mesh) return 0;
  const MeshData& data = mesh->data();
  float longest2 = 0;
  for (size_t i = 0; i < data.indices.size(); i += 3)
    for (size_t k = 0; k < 3; ++k)
      longest2 = std::max(longest2, length_squared(data.positions[data.indices[i + k]] -
                                                   data.positions[data.indices[i + (k + 1) % 3]]));
  return std::sqrt(longest2);
}

}  // namespace turbid
