#include "integrator/aov.h"

#include <span>

#include "core/parallel.h"
#include "integrator/camera_sample.h"
#include "integrator/integrators.h"
#include "scene/values.h"

namespace turbid {
namespace {

/// A kind of layer: its channels as Mitsuba names them, and its numbers; or, without numbers, a range of orders.
struct AovType {
  const char* name;
  std::vector<std::string> channels;
  void (*write)(const Features&, double* sums);
  int min_order = 0, max_order = 0;
};

void add3(double* sums, const Vec3& v) {
  for (int c = 0; c < 3; ++c) sums[c] += static_cast<double>(v[c]);
}
void add2(double* sums, const Vec2& v) {
  for (int c = 0; c < 2; ++c) sums[c] += static_cast<double>(v[c]);
}

const std::vector<std::string> kRgb = {".R", ".G", ".B"}, kXyz = {".X", ".Y", ".Z"}, kUv = {".U", ".V"};

const std::vector<AovType>& aov_types() {
  static const std::vector<AovType> types = {
      {"albedo", kRgb,
       [](const Features& f, double* sums) {
         for (int c = 0; c < kChannels; ++c) sums[c] += static_cast<double>(f.albedo[c]);
       }},
      {"depth", {".T"}, [](const Features& f, double* sums) { sums[0] += static_cast<double>(f.depth); }},
      {"position", kXyz, [](const Features& f, double* sums) { add3(sums, f.position); }},
      {"uv", kUv, [](const Features& f, double* sums) { add2(sums, f.uv); }},
      {"geo_normal", kXyz, [](const Features& f, double* sums) { add3(sums, f.geometric_normal); }},
      {"sh_normal", kXyz, [](const Features& f, double* sums) { add3(sums, f.shading_normal); }},
      {"dp_du", kXyz, [](const Features& f, double* sums) { add3(sums, f.dp_du); }},
      {"dp_dv", kXyz, [](const Features& f, double* sums) { add3(sums, f.dp_dv); }},
      {"prim_index", {".I"}, [](const Features& f, double* sums) { sums[0] += f.primitive; }},
      {"shape_index", {".I"}, [](const Features& f, double* sums) { sums[0] += f.shape; }},
      {"unscattered", kRgb, nullptr, 0, 0},
      {"single_scattering", kRgb, nullptr, 1, 1},
      {"double_scattering", kRgb, nullptr, 2, 2},
      {"multiple_scattering", kRgb, nullptr, 3, kOrderClasses - 1},
  };
  return types;
}

const AovType* find_type(const std::string& name) {
  for (const AovType& type : aov_types())
    if (name == type.name) return &type;
  return nullptr;
}

IntegratorSetup make_aov(const Properties& p) {
  IntegratorSetup setup;
  const SceneNode* inner = p.child("integrator");
  if (inner) setup = integrator_table().make(*inner, nullptr);

  std::vector<AovLayer> layers;
  std::vector<OrderLayer> orders;
  std::vector<std::string> names;
  if (setup.integrator) names = setup.integrator->layer_names();
  for (const std::string& word : split_words(p.string("aovs"))) {
    const size_t colon = word.find(':');
    if (colon == 0 || colon == std::string::npos || colon + 1 == word.size())
      p.refuse("aovs", "expects NAME:TYPE, found '" + word + "'");
    const std::string name = word.substr(0, colon), kind = word.substr(colon + 1);
    const AovType* type = find_type(kind);
    if (kind == "boundary_test" || kind == "duv_dx" || kind == "duv_dy")
      p.refuse("aovs", "has a type that is not supported: '" + kind + "'");
    if (!type) {
      std::vector<std::string> known;
      for (const AovType& t : aov_types()) known.emplace_back(t.name);
      p.refuse("aovs", "has the unknown type '" + kind + "'" + suggestion(kind, known));
    }
    const size_t channel = names.size();
    for (const std::string& ending : type->channels) {
      if (std::find(names.begin(), names.end(), name + ending) != names.end())
        p.refuse("aovs", "gives the name '" + name + "' twice");
      names.push_back(name + ending);
    }
    if (type->write)
      layers.push_back({type->name, channel});
    else
      orders.push_back({type->min_order, type->max_order, channel});
  }
  if (!orders.empty() && !(setup.integrator && setup.integrator->split_orders(orders)))
    p.refuse("aovs", std::string("asks for scattering orders, which ") +
                         (inner ? inner->describe() + " does not tell apart" : "only an integrator inside can tell"));
  setup.integrator = std::make_shared<AovIntegrator>(setup.integrator, std::move(layers), std::move(names));
  return setup;
}

}  // namespace

void AovIntegrator::prepare(const Scene& scene, uint64_t seed, const StopFlag& stop) {
  if (inner_) inner_->prepare(scene, seed, stop);
}

bool AovIntegrator::render_pass(const Scene& scene, const Pass& pass, Film& film, const StopFlag& stop) {
  if (inner_ && !inner_->render_pass(scene, pass, film, stop)) return false;
  if (!layers_.empty()) {
    parallel_for(static_cast<size_t>(film.size().y), [&](size_t row) {
      if (!stop.requested()) add_features(scene, pass, static_cast<int>(row), film);
    });
    if (stop.requested()) return false;
  }
  if (!inner_) film.add_samples(pass.sample_count);
  return true;
}

/// The same sensor rays as those of the picture, drawn again.
void AovIntegrator::add_features(const Scene& scene, const Pass& pass, int row, Film& film) const {
  Sampler sampler(scene.sampler(), pass.seed);
  std::vector<void (*)(const Features&, double*)> writers;
  for (const AovLayer& layer : layers_) writers.push_back(find_type(layer.type)->write);
  for (int x = 0; x < film.size().x; ++x) {
    const Vec2i on_film = Vec2i(x, row) + scene.film().crop_offset;
    const std::span<double> sums =
        film.layers(static_cast<size_t>(row) * static_cast<size_t>(film.size().x) + static_cast<size_t>(x));
    for (uint64_t i = pass.first_sample; i < pass.first_sample + pass.sample_count; ++i) {
      const SensorRay camera = start_camera_sample(scene, on_film, i, sampler);
      const Features features = find_features(scene, camera, sees_media(), sampler);
      if (!features.albedo.is_finite()) continue;
      for (size_t k = 0; k < layers_.size(); ++k) writers[k](features, &sums[layers_[k].channel]);
    }
  }
}

IntegratorPlugin aov_row() {
  return {
      "aov",
      {},
      "wraps an image integrator and writes layers beside its picture: what sensor rays come to first behind smooth "
      "glass, and light by its order of scattering",
      {{"aovs", ParameterType::kString, kRequired,
        "NAME:TYPE, ... with the types albedo, depth, position, uv, geo_normal, sh_normal, dp_du, dp_dv, "
        "prim_index, shape_index, unscattered, single_scattering, double_scattering, multiple_scattering"},
       {"integrator", ParameterType::kIntegrator, kOptional, "the image integrator; left out: a black picture"},
       {"scene_unit", ParameterType::kString, kOptional, "as in the image integrators"}},
      make_aov};
}

}  // namespace turbid
