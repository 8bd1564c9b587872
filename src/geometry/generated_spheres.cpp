#include <cmath>
#include <map>
#include <stdexcept>

#include "core/rng.h"
#include "geometry/generated.h"
#include "geometry/row_mesh.h"

namespace turbid {

void require(bool condition, const std::string& message) {
  if (!condition) throw std::invalid_argument(message);
}

MeshData make_icosphere(float radius, int subdivisions) {
  require(radius > 0, "icosphere: the radius must be positive");
  require(subdivisions >= 0 && subdivisions <= 10, "icosphere: subdivisions must be between 0 and 10");
  MeshData mesh;
  mesh.name = "icosphere";
  const float g = std::numbers::phi_v<float>;
  for (const Vec3& v :
       {Vec3(-1, g, 0), Vec3(1, g, 0), Vec3(-1, -g, 0), Vec3(1, -g, 0), Vec3(0, -1, g), Vec3(0, 1, g), Vec3(0, -1, -g),
        Vec3(0, 1, -g), Vec3(g, 0, -1), Vec3(g, 0, 1), Vec3(-g, 0, -1), Vec3(-g, 0, 1)})
    mesh.normals.push_back(normalize(v));
  mesh.indices = {0, 11, 5, 0, 5, 1, 0, 1, 7, 0, 7, 10, 0, 10, 11, 1, 5, 9, 5, 11, 4,  11, 10, 2,  10, 7, 6, 7, 1, 8,
                  3, 9,  4, 3, 4, 2, 3, 2, 6, 3, 6, 8,  3, 8,  9,  4, 9, 5, 2, 4,  11, 6,  2,  10, 8,  6, 7, 9, 8, 1};
  for (int level = 0; level < subdivisions; ++level) {
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
    const auto middle = [&](uint32_t a, uint32_t b) {
      const auto [at, is_new] = middles.try_emplace(std::minmax(a, b), static_cast<uint32_t>(mesh.normals.size()));
      if (is_new) mesh.normals.push_back(normalize(mesh.normals[a] + mesh.normals[b]));
      return at->second;
    };
    std::vector<uint32_t> finer;
    finer.reserve(4 * mesh.indices.size());
    for (size_t i = 0; i < mesh.indices.size(); i += 3) {
      const uint32_t a = mesh.indices[i], b = mesh.indices[i + 1], c = mesh.indices[i + 2];
      const uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {a, ab, ca, b, bc, ab, c, ca, bc, ab, bc, ca});
    }
    mesh.indices = std::move(finer);
  }
  for (const Vec3& n : mesh.normals) mesh.positions.push_back(n * radius);
  return mesh;
}

MeshData make_bumpy_sphere(float radius, float amplitude, float frequency, uint32_t seed, int subdivisions) {
  require(std::abs(amplitude) < 1, "bumpy_sphere: the amplitude must be between -1 and 1");
  require(std::isfinite(frequency), "bumpy_sphere: the frequency must be finite");
  MeshData mesh = make_icosphere(radius, subdivisions);
  mesh.name = "bumpy sphere";
  for (size_t i = 0; i < mesh.positions.size(); ++i)
    mesh.positions[i] *= 1 + amplitude * smooth_noise(mesh.normals[i] * frequency, seed);
  compute_vertex_normals(mesh);
  return mesh;
}

float smooth_noise(const Vec3& p, uint32_t seed) {
  // Gradient noise (Perlin 1985) with a quintic blend (Perlin 2002); the gradients are random unit vectors.
  const Vec3 cell(std::floor(p.x), std::floor(p.y), std::floor(p.z));
  const Vec3 f = p - cell;
  const auto fade = [](float t) { return t * t * t * (t * (t * 6 - 15) + 10); };
  float sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 o(static_cast<float>(corner & 1), static_cast<float>(corner >> 1 & 1), static_cast<float>(corner >> 2));
    const Vec3 at = cell + o;
    Rng rng(hash_counters(seed, static_cast<int64_t>(at.x), static_cast<int64_t>(at.y), static_cast<int64_t>(at.z)));
    const float z = 2 * rng.next_float() - 1, phi = 2 * kPi * rng.next_float(), r = safe_sqrt(1 - z * z);
    const Vec3 d = f - o;
    const auto weight = [&](float offset, float t) { return offset > 0 ? fade(t) : 1 - fade(t); };
    sum +=
        weight(o.x, f.x) * weight(o.y, f.y) * weight(o.z, f.z) * dot(Vec3(r * std::cos(phi), r * std::sin(phi), z), d);
  }
  constexpr float kStretch = 1.15f;  // unit gradients reach about 0.87
  return std::clamp(kStretch * sum, -1.0f, 1.0f);
}

}  // namespace turbid
