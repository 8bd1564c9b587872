#include "table/field_plot.h"

#include <algorithm>
#include <cmath>

namespace turbid {
namespace {

const Vec3 kAxis(0, 0, 1);

Vec3 place(float along, float across) { return {across, 0, along}; }

/// Black, red, yellow, white.
Vec3 heat(float x) {
  return {std::clamp(3 * x, 0.0f, 1.0f), std::clamp(3 * x - 1, 0.0f, 1.0f), std::clamp(3 * x - 2, 0.0f, 1.0f)};
}

class Canvas {
 public:
  explicit Canvas(int size) : size_(size), image_(size, size, {"R", "G", "B"}) {}
  void set(int x, int y, const Vec3& color) {
    if (x < 0 || y < 0 || x >= size_ || y >= size_) return;
    const size_t at = static_cast<size_t>(y) * static_cast<size_t>(size_) + static_cast<size_t>(x);
    for (int c = 0; c < 3; ++c) image_.channel(static_cast<size_t>(c))[at] = color[c];
  }
  Image take() { return std::move(image_); }

 private:
  int size_;
  Image image_;
};

/// The outline of a lobe about a pixel.
void draw_lobe(Canvas& canvas, const LobeField& field, const Vec3& x, float pixel_x, float pixel_y, float length) {
  constexpr int kDirections = 720;
  std::vector<float> values;
  for (int i = 0; i < kDirections; ++i) {
    const float phi = 2 * kPi * static_cast<float>(i) / kDirections;
    values.push_back(field.eval(x, kAxis, place(std::cos(phi), std::sin(phi))));
  }
  const float largest = *std::max_element(values.begin(), values.end());
  if (!(largest > 0)) return;
  for (int i = 0; i < kDirections; ++i) {
    const float phi = 2 * kPi * static_cast<float>(i) / kDirections;
    const float radius = length * values[static_cast<size_t>(i)] / largest;
    canvas.set(static_cast<int>(std::lround(pixel_x + radius * std::cos(phi))),
               static_cast<int>(std::lround(pixel_y - radius * std::sin(phi))), {0.1f, 0.4f, 1});
  }
}

}  // namespace

Image plot_field(const LobeField& field, double reach, int size) {
  Canvas canvas(size);
  const auto extent = static_cast<float>(reach);
  const float scale = 2 * extent / static_cast<float>(size);
  constexpr float kDecades = 6;
  const auto at_pixel = [&](int x, int y) {
    return place((static_cast<float>(x) + 0.5f) * scale - extent, extent - (static_cast<float>(y) + 0.5f) * scale);
  };
  std::vector<float> logarithms;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x)
      logarithms.push_back(std::log10(std::max(field.density(at_pixel(x, y), kAxis), 1e-30f)));
  const float brightest = *std::max_element(logarithms.begin(), logarithms.end());
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x)
      canvas.set(x, y,
                 heat(1 + (logarithms[static_cast<size_t>(y) * static_cast<size_t>(size) + static_cast<size_t>(x)] -
                           brightest) /
                              kDecades));
  constexpr int kLobes = 8;
  const float step = static_cast<float>(size) / kLobes;
  for (int j = 0; j < kLobes; ++j)
    for (int i = 0; i < kLobes; ++i) {
      const float x = (static_cast<float>(i) + 0.5f) * step, y = (static_cast<float>(j) + 0.5f) * step;
      draw_lobe(canvas, field, place(x * scale - extent, extent - y * scale), x, y, 0.45f * step);
    }
  return canvas.take();
}

}  // namespace turbid
