#include "table/sphere_plot.h"

#include <cmath>

#include "table/plot_colors.h"

namespace turbid {
namespace {

const Vec3 kAxis(0, 0, 1);

Vec3 position(const Quadtree::Place& place) { return {place.rho, 0, place.z}; }

/// A direction of the frame of SagittalView in that of the source: there z is the line from the source, x is across it,
/// away from the axis.
Vec3 from_view(const Quadtree::Place& place, const Vec3& d) {
  const Vec3 radial = normalize(position(place)), across(radial.z, 0, -radial.x);
  return radial * d.z + across * d.x + Vec3(0, d.y, 0);
}

/// Source radiance over the disk of a lobe; below 0 beyond the rim.
class Disk {
 public:
  Disk(const LightField& field, const Quadtree::Place& place, float optimal_axis, int size)
      : size_(size), values_(static_cast<size_t>(size) * static_cast<size_t>(size), -1) {
    const float sine = std::sin(optimal_axis), cosine = std::cos(optimal_axis);
    for (int j = 0; j < size; ++j)
      for (int i = 0; i < size; ++i) {
        const float middle = static_cast<float>(size) / 2, across = (static_cast<float>(i) + 0.5f) / middle - 1,
                    up = 1 - (static_cast<float>(j) + 0.5f) / middle;
        const float square = across * across + up * up;  // sin^2 of half the angle to the axis
        if (square > 1) continue;
        const float along = 1 - 2 * square, sideways = 2 * std::sqrt(1 - square);
        const float in_plane = across * sideways;
        const Vec3 d(in_plane * cosine + along * sine, up * sideways, along * cosine - in_plane * sine);
        values_[index(i, j)] = field.eval(position(place), kAxis, from_view(place, d));
      }
  }
  int size() const { return size_; }
  float at(int i, int j) const { return values_[index(i, j)]; }
  float largest() const { return *std::max_element(values_.begin(), values_.end()); }
  /// Whether an isoline runs between this pixel and the next to the right or below.
  bool isoline_at(int i, int j, float largest) const {
    const float value = at(i, j);
    if (value < 0) return false;
    for (const auto& [x, y] : {std::pair{i + 1, j}, std::pair{i, j + 1}})
      if (x < size_ && y < size_ && at(x, y) >= 0 && step(at(x, y), largest) != step(value, largest)) return true;
    return false;
  }

 private:
  static int step(float value, float largest) {
    constexpr float kMost = 3.32193f * kSphereDecades;
    return static_cast<int>(std::clamp(std::log2(largest / std::max(value, 1e-30f)), 0.0f, kMost));
  }
  size_t index(int i, int j) const {
    return static_cast<size_t>(j) * static_cast<size_t>(size_) + static_cast<size_t>(i);
  }

  int size_;
  std::vector<float> values_;
};

void put(Image& image, int x, int y, const Vec3& color) {
  const size_t at = static_cast<size_t>(y) * static_cast<size_t>(image.width()) + static_cast<size_t>(x);
  for (int c = 0; c < 3; ++c) image.channel(static_cast<size_t>(c))[at] = color[c];
}

}  // namespace

Image plot_spheres(const LightField& computed, const QuadtreeField& sampled, const std::vector<Quadtree::Place>& places,
                   int disk) {
  constexpr int kGap = 8, kColumns = 3;
  const int step = disk + kGap;
  Image image(kColumns * step + kGap, static_cast<int>(places.size()) * step + kGap, {"R", "G", "B"});
  for (int row = 0; row < static_cast<int>(places.size()); ++row) {
    const Quadtree::Place& place = places[static_cast<size_t>(row)];
    const float axis = sampled.optimal_axis(place);
    const Disk a(computed, place, axis, disk), b(sampled, place, axis, disk);
    const float largest = a.largest();
    for (int j = 0; j < disk; ++j)
      for (int i = 0; i < disk; ++i) {
        if (a.at(i, j) < 0) continue;
        const int x = kGap + i, y = kGap + row * step + j;
        const auto color = [&](float value) {
          return heat(1 + std::log10(std::max(value, 1e-30f) / largest) / kSphereDecades);
        };
        const bool on_a = a.isoline_at(i, j, largest), on_b = b.isoline_at(i, j, largest);
        put(image, x, y, on_a ? kPlotBlue : color(a.at(i, j)));
        put(image, x + step, y, on_b ? kPlotGreen : color(b.at(i, j)));
        put(image, x + 2 * step, y, on_a ? kPlotBlue : on_b ? kPlotGreen : Vec3(0.04f));
      }
  }
  return image;
}

double compression_error(const LightField& computed, const Quadtree::Place& place, SourceKind kind) {
  static const LobeDirections directions;
  const bool asymmetric = kind == SourceKind::kRay;
  std::vector<float> lobe;
  for (size_t k = 0; k < LobeDirections::kCount; ++k)
    lobe.push_back(
        computed.eval(position(place), kAxis, from_view(place, {directions.x[k], directions.y[k], directions.z[k]})));
  std::vector<float> channels(kChannels * lobe.size()), numbers(SampledLobe::size(asymmetric));
  for (size_t i = 0; i < channels.size(); ++i) channels[i] = lobe[i % lobe.size()];
  SampledLobe::fit(channels.data(), asymmetric, numbers.data());
  const SampledLobe fitted(numbers.data(), asymmetric);
  double square = 0, difference = 0;
  for (size_t k = 0; k < LobeDirections::kCount; ++k) {
    const auto value = static_cast<double>(lobe[k]), solid = static_cast<double>(directions.solid_angle[k]);
    const auto sampled = static_cast<double>(fitted.eval(0, {directions.x[k], directions.y[k], directions.z[k]}));
    square += solid * value * value;
    difference += solid * (sampled - value) * (sampled - value);
  }
  return square > 0 ? std::sqrt(difference / square) : 0;
}

}  // namespace turbid
