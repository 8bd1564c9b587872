#include <algorithm>
#include <array>
#include <cmath>

#include "core/frame.h"
#include "geometry/generated.h"
#include "geometry/row_mesh.h"

namespace turbid {
namespace {
/// v / |v|, to the same bits for any order of the components, so that neighbouring faces of a box fit without a gap.
Vec3 normalize_symmetric(const Vec3& v) {
  std::array<float, 3> squares{v.x * v.x, v.y * v.y, v.z * v.z};
  std::sort(squares.begin(), squares.end());
  const float norm = std::sqrt((squares[0] + squares[1]) + squares[2]);
  return {v.x / norm, v.y / norm, v.z / norm};
}
}  // namespace

MeshData make_rounded_box(const Vec3& half, float radius, int segments) {
  require(half.x > 0 && half.y > 0 && half.z > 0, "rounded_box: the half sizes must be positive");
  require(radius > 0 && radius <= std::min({half.x, half.y, half.z}),
          "rounded_box: the radius must be positive and no larger than the smallest half size");
  require(segments >= 1 && segments <= 1024, "rounded_box: the number of segments must be between 1 and 1024");
  const Vec3 core = half - Vec3(radius);

  // Across a face the direction goes from -45 to 0 degrees around one edge and from 0 to 45 around the other; between
  // them the face is flat. Each entry: tangent of the angle, side of the core.
  std::vector<Vec2> across;
  for (const float side : {-1.0f, 1.0f})
    for (int i = 0; i <= segments; ++i) {
      const int step = side < 0 ? segments - i : i;
      const float tangent =
          step == segments ? 1 : std::tan(kPi / 4 * static_cast<float>(step) / static_cast<float>(segments));
      across.push_back({side * tangent, side});
    }
  const auto columns = static_cast<uint32_t>(across.size());

  RowMesh mesh("rounded box");
  for (int axis = 0; axis < 3; ++axis)
    for (const float sign : {-1.0f, 1.0f}) {
      // Rows along the first and columns along the second of two axes whose cross product is the outward axis.
      const int row_axis = (axis + (sign > 0 ? 1 : 2)) % 3, column_axis = (axis + (sign > 0 ? 2 : 1)) % 3;
      for (uint32_t r = 0; r < columns; ++r) {
        const uint32_t row = mesh.size();
        for (uint32_t c = 0; c < columns; ++c) {
          Vec3 direction, centre;
          direction[axis] = sign;
          direction[row_axis] = across[r].x;
          direction[column_axis] = across[c].x;
          centre[axis] = sign * core[axis];
          centre[row_axis] = across[r].y * core[row_axis];
          centre[column_axis] = across[c].y * core[column_axis];
          const Vec3 n = normalize_symmetric(direction);
          const auto fraction = [&](uint32_t i) { return static_cast<float>(i) / static_cast<float>(columns - 1); };
          mesh.add(centre + n * radius, n, {fraction(c), fraction(r)});
        }
        if (r > 0) mesh.join(row - columns, row, columns);
      }
    }
  return mesh.take();
}

MeshData make_grid(const Vec2& half, int nx, int nz, const std::function<float(float, float)>& height) {
  require(half.x > 0 && half.y > 0, "grid: the half sizes must be positive");
  require(nx >= 1 && nz >= 1 && nx <= 16384 && nz <= 16384, "grid: the numbers of cells must be between 1 and 16384");
  const auto at = [&](float x, float z) { return height ? height(x, z) : 0.0f; };
  const float dx = half.x / static_cast<float>(nx), dz = half.y / static_cast<float>(nz);  // half a cell
  RowMesh mesh("grid");
  const auto columns = static_cast<uint32_t>(nx) + 1;
  for (int k = 0; k <= nz; ++k) {
    const uint32_t row = mesh.size();
    for (int j = 0; j <= nx; ++j) {
      const Vec2 uv(static_cast<float>(j) / static_cast<float>(nx), static_cast<float>(k) / static_cast<float>(nz));
      const float x = half.x * (2 * uv.x - 1), z = half.y * (2 * uv.y - 1);
      const float slope_x = (at(x + dx, z) - at(x - dx, z)) / (2 * dx),
                  slope_z = (at(x, z + dz) - at(x, z - dz)) / (2 * dz);
      mesh.add({x, at(x, z), z}, normalize(Vec3(-slope_x, 1, -slope_z)), uv);
    }
    if (k > 0) mesh.join(row - columns, row, columns);
  }
  return mesh.take();
}

MeshData make_tube(std::span<const Vec3> points, std::span<const float> radii, int segments) {
  require(points.size() >= 2, "tube: needs at least 2 points");
  require(radii.size() == 1 || radii.size() == points.size(), "tube: needs one radius, or one per point");
  require(std::all_of(radii.begin(), radii.end(), [](float r) { return r > 0 && std::isfinite(r); }),
          "tube: radii must be positive");
  require(segments >= 3 && segments <= 65536, "tube: the number of segments must be between 3 and 65536");
  for (size_t i = 1; i < points.size(); ++i) require(points[i] != points[i - 1], "tube: two points in a row are equal");
  const auto columns = static_cast<uint32_t>(segments) + 1;
  const int cap_rows = std::max(2, segments / 4);

  RowMesh mesh("tube");
  Vec3 side = Frame(normalize(points[1] - points[0])).s;
  const auto add_row = [&](const Vec3& centre, const Vec3& tangent, float radius, const Vec2& latitude, float v) {
    const Vec3 other = cross(side, tangent);
    const float c = latitude.x, s = latitude.y;
    const uint32_t row = mesh.size();
    for (uint32_t j = 0; j < columns; ++j) {
      const float phi =
          2 * kPi * static_cast<float>(j % static_cast<uint32_t>(segments)) / static_cast<float>(segments);
      const Vec3 n = (side * std::cos(phi) + other * std::sin(phi)) * c + tangent * s;
      mesh.add(centre + n * radius, n, {static_cast<float>(j) / static_cast<float>(segments), v});
    }
    if (row > 0) mesh.join(row - columns, row, columns);
  };
  const size_t last = points.size() - 1;
  for (size_t i = 0; i <= last; ++i) {
    const Vec3 before = normalize(points[i] - points[i > 0 ? i - 1 : 0]),
               after = normalize(points[i < last ? i + 1 : i] - points[i]);
    const Vec3 tangent = i == 0 ? after : i == last ? before : normalize(before + after);
    side = normalize(side - tangent * dot(side, tangent));  // carried along with the least turn
    const float radius = radii.size() == 1 ? radii[0] : radii[i];
    const float v = static_cast<float>(i) / static_cast<float>(last);
    // Cosine and sine of the latitude of row k of a cap; the pole exactly, so that it is a point.
    const auto latitude = [&](int k, float sign) {
      const float angle = kPi / 2 * static_cast<float>(k) / static_cast<float>(cap_rows);
      return k == cap_rows ? Vec2(0, sign) : Vec2(std::cos(angle), sign * std::sin(angle));
    };
    if (i == 0)
      for (int k = cap_rows; k > 0; --k) add_row(points[i], tangent, radius, latitude(k, -1), v);
    add_row(points[i], tangent, radius, Vec2(1, 0), v);
    if (i == last)
      for (int k = 1; k <= cap_rows; ++k) add_row(points[i], tangent, radius, latitude(k, 1), v);
  }
  return mesh.take();
}

}  // namespace turbid
