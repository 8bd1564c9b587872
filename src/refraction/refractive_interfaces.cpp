#include "refraction/refractive_interfaces.h"

#include <fmt/format.h>

#include "core/log.h"

namespace turbid {

RefractiveInterfaces::RefractiveInterfaces(const Scene& scene) {
  if (scene.has_priorities()) {
    log_warning(
        "light is not followed through refractive boundaries in scenes with priorities or a world medium: path "
        "sampling alone finds it");
    return;
  }
  for (const Object& object : scene.objects()) {
    const auto* mesh = dynamic_cast<const TriangleMesh*>(object.shape.get());
    const auto* bsdf = dynamic_cast<const Dielectric*>(object.bsdf.get());
    if (!mesh || !bsdf || bsdf->eta() == 1 || object.emitter) continue;
    if (!mesh->is_closed())
      log_warning(fmt::format(
          "mesh '{}' has holes or turned triangles: light that comes in there is not refracted, or from the "
          "wrong side",
          mesh->name()));
    index_[&object] = all_.size();
    all_.emplace_back(object, *mesh, *bsdf);
  }
}

const RefractiveInterface* RefractiveInterfaces::find(const Object& object) const {
  const auto found = index_.find(&object);
  return found == index_.end() ? nullptr : &all_[found->second];
}

}  // namespace turbid
