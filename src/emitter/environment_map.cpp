#include "emitter/environment_map.h"

#include <stdexcept>

namespace turbid {
namespace {

template <class T>
T bilinear(const T& a, const T& b, const T& c, const T& d, float x, float y) {
  return (a * (1 - x) + b * x) * (1 - y) + (c * (1 - x) + d * x) * y;
}

/// A number in [0,1] with density proportional to f0 (1 - t) + f1 t; not both zero.
float sample_linear(float f0, float f1, float u) {
  const float root = std::sqrt(f0 * f0 * (1 - u) + f1 * f1 * u);
  return std::min(u * (f0 + f1) / (f0 + root), 1.0f);
}

}  // namespace

EnvironmentMap::EnvironmentMap(std::vector<Spectrum> pixels, int width, int height, const Transform& to_world,
                               float scale)
    : pixels_(std::move(pixels)), width_(width), height_(height), to_world_(to_world), to_local_(to_world.inverse()) {
  if (width < 1 || height < 2)
    throw std::invalid_argument("an environment map needs at least one column and two rows of pixels");
  if (pixels_.size() != static_cast<size_t>(width) * static_cast<size_t>(height))
    throw std::invalid_argument("an environment map needs one value for each of its pixels");
  if (to_world.uniform_scale() == 0)
    throw std::invalid_argument("the to_world transform of an environment map must not shear or scale unevenly");
  for (Spectrum& p : pixels_) {
    p *= scale;
    if (!p.is_finite() || p.min() < 0)
      throw std::invalid_argument("a pixel of an environment map is negative or not finite");
  }
  build_distribution();
}

void EnvironmentMap::build_distribution() {
  for (int row = 0; row < height_; ++row)
    versine_.push_back(2 * sqr(std::sin(row * std::numbers::pi / (2 * (height_ - 1)))));
  std::vector<float> row_weights;
  double integral[kChannels] = {};
  for (int row = 0; row + 1 < height_; ++row) {
    const auto r = static_cast<size_t>(row);
    const double solid_angle = (versine_[r + 1] - versine_[r]) * 2 * std::numbers::pi / width_;
    std::vector<float> weights;
    double row_sum = 0;
    for (int column = 0; column < width_; ++column) {
      const auto l = corner_luminances(column, row);
      weights.push_back((l[0] + l[1] + l[2] + l[3]) / 4);
      row_sum += static_cast<double>(weights.back());
      for (const Spectrum* p : corners(column, row))
        for (int c = 0; c < kChannels; ++c) integral[c] += static_cast<double>((*p)[c]) / 4 * solid_angle;
    }
    columns_.emplace_back(weights);
    row_weights.push_back(static_cast<float>(row_sum * solid_angle));
    luminance_integral_ += row_sum * solid_angle;
  }
  rows_ = DiscreteDistribution(row_weights);
  for (int c = 0; c < kChannels; ++c) radiance_integral_[c] = static_cast<float>(integral[c]);
}

std::array<const Spectrum*, 4> EnvironmentMap::corners(int column, int row) const {
  const auto w = static_cast<size_t>(width_), left = static_cast<size_t>(column), right = (left + 1) % w;
  const Spectrum* upper = pixels_.data() + static_cast<size_t>(row) * w;
  const Spectrum* lower = upper + w;
  return {upper + left, upper + right, lower + left, lower + right};
}

std::array<float, 4> EnvironmentMap::corner_luminances(int column, int row) const {
  const auto p = corners(column, row);
  return {p[0]->luminance(), p[1]->luminance(), p[2]->luminance(), p[3]->luminance()};
}

Spectrum EnvironmentMap::radiance(const Place& place) const {
  const auto p = corners(place.column, place.row);
  return bilinear(*p[0], *p[1], *p[2], *p[3], place.x, place.y);
}

float EnvironmentMap::density(const Place& place) const {
  const auto l = corner_luminances(place.column, place.row);
  return static_cast<float>(static_cast<double>(bilinear(l[0], l[1], l[2], l[3], place.x, place.height)) /
                            luminance_integral_);
}

EnvironmentMap::Place EnvironmentMap::locate(const Vec3& world_direction) const {
  const Vec3 d = normalize(to_local_.vector(world_direction));
  const float across = std::atan2(d.x, -d.z) * (0.5f * kInvPi) * static_cast<float>(width_) - 0.5f;
  const float cell = std::floor(across);
  Place place;
  place.x = across - cell;
  place.column = (static_cast<int>(cell) + width_) % width_;
  const float squared_radius = d.x * d.x + d.z * d.z;
  const float down = std::atan2(std::sqrt(squared_radius), d.y) * kInvPi * static_cast<float>(height_ - 1);
  place.row = std::min(static_cast<int>(down), height_ - 2);
  place.y = std::min(down - static_cast<float>(place.row), 1.0f);
  // 1 - cos(theta), without cancellation near the poles
  const double sine2 = static_cast<double>(squared_radius), cosine = static_cast<double>(d.y);
  const double versine = cosine > 0 ? sine2 / (1 + cosine) : 2 - sine2 / (1 - cosine);
  const auto r = static_cast<size_t>(place.row);
  place.height = std::clamp(static_cast<float>((versine - versine_[r]) / (versine_[r + 1] - versine_[r])), 0.0f, 1.0f);
  return place;
}

Spectrum EnvironmentMap::Le(const Vec3& direction) const { return radiance(locate(direction)); }

float EnvironmentMap::pdf_direct_w(const Vec3& direction) const {
  return luminance_integral_ > 0 ? density(locate(direction)) : 0;
}

std::optional<DirectLightSample> EnvironmentMap::sample_direct(const Vec3&, const Vec2& u) const {
  if (!(luminance_integral_ > 0)) return std::nullopt;
  const DiscreteSample row = rows_.sample(u.y);
  const DiscreteSample column = columns_[row.index].sample(u.x);
  Place place;
  place.row = static_cast<int>(row.index);
  place.column = static_cast<int>(column.index);
  const auto l = corner_luminances(place.column, place.row);
  place.height = sample_linear(l[0] + l[1], l[2] + l[3], row.u);
  const float left = l[0] + (l[2] - l[0]) * place.height, right = l[1] + (l[3] - l[1]) * place.height;
  place.x = sample_linear(left, right, column.u);

  const double low = versine_[row.index], high = versine_[row.index + 1];
  const double versine = low + (high - low) * static_cast<double>(place.height);
  const double theta = 2 * std::asin(std::sqrt(std::min(versine / 2, 1.0)));
  place.y = std::clamp(static_cast<float>(theta / std::numbers::pi * (height_ - 1)) - static_cast<float>(place.row),
                       0.0f, 1.0f);
  const double phi = 2 * std::numbers::pi * (place.column + 0.5 + static_cast<double>(place.x)) / width_;
  const double sine = std::sqrt(std::max(0.0, versine * (2 - versine)));
  const Vec3 local(static_cast<float>(std::sin(phi) * sine), static_cast<float>(1 - versine),
                   static_cast<float>(-std::cos(phi) * sine));
  const float pdf_w = density(place);
  if (!(pdf_w > 0)) return std::nullopt;
  return DirectLightSample{.wi = normalize(to_world_.vector(local)),
                           .distance = kInfinity,
                           .position = Vec3(0),
                           .weight = radiance(place) / pdf_w,
                           .pdf_w = pdf_w};
}

}  // namespace turbid
