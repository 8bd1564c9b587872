#include "texture/grid_volume.h"

#include "texture/unit_cube.h"

namespace turbid {
namespace {

/// Voxel coordinates beyond this are as good as this: they still fit an int and their neighbours differ.
constexpr float kFar = 4e6f;

int wrapped(int i, int n, GridWrap wrap) {
  if (i >= 0 && i < n) return i;
  switch (wrap) {
    case GridWrap::kClamp:
      return std::clamp(i, 0, n - 1);
    case GridWrap::kRepeat: {
      const int r = i % n;
      return r < 0 ? r + n : r;
    }
    case GridWrap::kMirror: {
      int r = static_cast<int>(i % (2 * static_cast<int64_t>(n)));
      if (r < 0) r += 2 * n;
      return r < n ? r : 2 * n - 1 - r;
    }
  }
  return 0;
}

/// A stretch of voxels along an axis, both ends included.
struct Stretch {
  int first, last;
};

/// The voxels of [0, n) that the unwrapped stretch [first, last] reads: at most three stretches.
std::vector<Stretch> stretches(int first, int last, int n, GridWrap wrap) {
  if (wrap == GridWrap::kClamp) return {{std::clamp(first, 0, n - 1), std::clamp(last, 0, n - 1)}};
  if (first < -n || last >= 2 * n || last - first >= n) return {{0, n - 1}};
  std::vector<Stretch> result;
  if (first < 0) {
    const int a = wrapped(first, n, wrap), b = wrapped(std::min(last, -1), n, wrap);
    result.push_back({std::min(a, b), std::max(a, b)});
  }
  if (last >= 0 && first < n) result.push_back({std::max(first, 0), std::min(last, n - 1)});
  if (last >= n) {
    const int a = wrapped(std::max(first, n), n, wrap), b = wrapped(last, n, wrap);
    result.push_back({std::min(a, b), std::max(a, b)});
  }
  return result;
}

int whole(float v) { return static_cast<int>(std::floor(std::clamp(v, -kFar, kFar))); }

}  // namespace

GridVolume::GridVolume(GridVoxels voxels, const GridSettings& settings)
    : voxels_(std::move(voxels)), settings_(settings), bounds_(bounds_of_unit_cube(settings.to_world)) {
  const Voxel& n = voxels_.size();
  to_grid_ = Transform::scale(n.x, n.y, n.z) * settings.to_world.inverse();
}

Spectrum GridVolume::eval(const Vec3& p) const {
  const Vec3 at = to_grid_.point(p);
  const Voxel& n = voxels_.size();
  const GridWrap wrap = settings_.wrap;
  if (settings_.filter == GridFilter::kNearest)
    return voxels_.at(wrapped(whole(at.x), n.x, wrap), wrapped(whole(at.y), n.y, wrap),
                      wrapped(whole(at.z), n.z, wrap));
  const int x = whole(at.x - 0.5f), y = whole(at.y - 0.5f), z = whole(at.z - 0.5f);
  const auto weight = [](float a, int i) { return std::clamp(a - 0.5f - static_cast<float>(i), 0.0f, 1.0f); };
  const float wx = weight(at.x, x), wy = weight(at.y, y), wz = weight(at.z, z);
  const std::array<Spectrum, 8> v =
      voxels_.corners(wrapped(x, n.x, wrap), wrapped(x + 1, n.x, wrap), wrapped(y, n.y, wrap),
                      wrapped(y + 1, n.y, wrap), wrapped(z, n.z, wrap), wrapped(z + 1, n.z, wrap));
  return lerp(lerp(lerp(v[0], v[1], wx), lerp(v[2], v[3], wx), wy),
              lerp(lerp(v[4], v[5], wx), lerp(v[6], v[7], wx), wy), wz);
}

ValueRange GridVolume::range(const Bounds3& box) const {
  const Bounds3 in_grid = bounds_of_mapped(box, to_grid_);
  const Voxel& n = voxels_.size();
  // A trilinear value at a is made of the voxels whose centres lie within 1 of it.
  const float reach = settings_.filter == GridFilter::kTrilinear ? 0.5f : 0.0f;
  const auto along = [&](float low, float high, int count) {
    const int more = settings_.filter == GridFilter::kTrilinear ? 1 : 0;
    return stretches(whole(low - reach), whole(high - reach) + more, count, settings_.wrap);
  };
  GridVoxels::Summary summary;
  for (const Stretch& z : along(in_grid.min.z, in_grid.max.z, n.z))
    for (const Stretch& y : along(in_grid.min.y, in_grid.max.y, n.y))
      for (const Stretch& x : along(in_grid.min.x, in_grid.max.x, n.x))
        voxels_.summarise({x.first, y.first, z.first}, {x.last, y.last, z.last}, summary);
  ValueRange result{summary.min, summary.max, {}};
  for (size_t c = 0; c < kChannels; ++c)
    result.mean[static_cast<int>(c)] = static_cast<float>(summary.sum[c] / summary.count);
  return result;
}

Vec3 GridVolume::resolution() const {
  // Voxel edges per bounding box edge; for a turned grid the box is larger than the cube, so this is about right.
  const Voxel& n = voxels_.size();
  const Bounds3 in_grid = bounds_of_mapped(bounds_, to_grid_);
  const Vec3 extent = in_grid.max - in_grid.min;
  return {std::max(extent.x, static_cast<float>(n.x)), std::max(extent.y, static_cast<float>(n.y)),
          std::max(extent.z, static_cast<float>(n.z))};
}

}  // namespace turbid
