#include <cmath>

#include "core/rng.h"
#include "geometry/generated.h"
#include "geometry/row_mesh.h"

namespace turbid {

WaveField::WaveField(const WaveSettings& settings) : settings_(settings) {
  require(settings.length > 0, "waves: the length must be positive");
  require(settings.trains >= 1 && settings.trains <= 256, "waves: the number of trains must be between 1 and 256");
  require(settings.sharpness >= 1, "waves: the sharpness must be at least 1");
  require(settings.lean >= 0 && settings.lean < 1, "waves: the lean must be at least 0 and below 1");
  Rng rng(hash_counters(settings.seed));
  float sum = 0;
  for (int i = 0; i < settings.trains; ++i) {
    // Lengths fall by kFinest in all; heights fall with them, so that all are equally steep.
    constexpr float kFinest = 0.25f;
    const float fraction = settings.trains > 1 ? static_cast<float>(i) / static_cast<float>(settings.trains - 1) : 0;
    const float share = std::pow(kFinest, fraction);
    const float angle = settings.spread * kPi / 180 * (2 * rng.next_float() - 1);
    const float number = 2 * kPi / (settings.length * share);
    trains_.push_back({number * std::cos(angle), number * std::sin(angle), 2 * kPi * rng.next_float(), share});
    sum += share;
  }
  for (Train& train : trains_) train.height *= settings.amplitude / sum;
}

float WaveField::operator()(float x, float z) const {
  // Bent crests: all trains are read at a place that is moved by noise about as wide as the longest wave.
  const Vec3 at = Vec3(x, 0, z) * (1 / settings_.length);
  const float bend_x = settings_.bend * settings_.length * smooth_noise(at, settings_.seed),
              bend_z = settings_.bend * settings_.length * smooth_noise(at, settings_.seed + 1);
  float height = 0;
  for (const Train& train : trains_) {
    const float t = train.x * (x + bend_x) + train.z * (z + bend_z) + train.phase;
    const float crest = std::pow(0.5f + 0.5f * std::sin(t - settings_.lean * std::sin(t)), settings_.sharpness);
    height += train.height * (2 * crest - 1);
  }
  return height;
}

MeshData make_slab(const Vec2& half, int nx, int nz, float depth, const std::function<float(float, float)>& height) {
  require(depth > 0, "slab: the depth must be positive");
  const MeshData top = make_grid(half, nx, nz, height);
  RowMesh mesh("slab");
  const auto columns = static_cast<uint32_t>(nx) + 1, rows = static_cast<uint32_t>(nz) + 1;
  const auto add = [&](uint32_t i, bool below, const Vec3& n) {
    const Vec3& p = top.positions[i];
    require(p.y > -depth, "slab: the surface reaches the depth");
    mesh.add(below ? Vec3(p.x, -depth, p.z) : p, n, top.uvs[i]);
  };
  for (uint32_t k = 0; k < rows; ++k) {
    for (uint32_t j = 0; j < columns; ++j) add(k * columns + j, false, top.normals[k * columns + j]);
    if (k > 0) mesh.join((k - 1) * columns, k * columns, columns);
  }
  const uint32_t floor = mesh.size();
  for (uint32_t k = 0; k < rows; ++k) {
    for (uint32_t j = 0; j < columns; ++j) add(k * columns + j, true, {0, -1, 0});
    if (k > 0) mesh.join(floor + k * columns, floor + (k - 1) * columns, columns);
  }
  // A wall below `count` border vertices of the surface that go on by `step`, its outside to their left.
  const auto wall = [&](uint32_t first, int64_t step, uint32_t count, const Vec3& n) {
    const uint32_t row = mesh.size();
    for (const bool below : {true, false})
      for (uint32_t i = 0; i < count; ++i) add(static_cast<uint32_t>(first + step * i), below, n);
    mesh.join(row, row + count, count);
  };
  const uint32_t last = rows * columns - 1;
  wall(0, 1, columns, {0, 0, -1});
  wall(last, -1, columns, {0, 0, 1});
  wall(last + 1 - columns, -int64_t{columns}, rows, {-1, 0, 0});
  wall(columns - 1, columns, rows, {1, 0, 0});
  return mesh.take();
}

}  // namespace turbid
