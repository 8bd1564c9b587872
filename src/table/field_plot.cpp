#include "table/field_plot.h"

#include <algorithm>
#include <cmath>

#include "table/plot_colors.h"

namespace turbid {
namespace {

const Vec3 kAxis(0, 0, 1);

Vec3 place(float along, float across) { return {across, 0, along}; }

/// Pixels over a part of the plane.
class Canvas {
 public:
  /// left, top: in mean free paths, of the picture's corner.
  Canvas(int width, int height, float left, float top, float pixels_per_length)
      : width_(width),
        height_(height),
        left_(left),
        top_(top),
        scale_(pixels_per_length),
        image_(width, height, {"R", "G", "B"}) {}

  void draw_density(const LightField& field) {
    constexpr float kDecades = 6;
    std::vector<float> logarithms;
    for (int y = 0; y < height_; ++y)
      for (int x = 0; x < width_; ++x) {
        const float along = left_ + (static_cast<float>(x) + 0.5f) / scale_,
                    across = top_ - (static_cast<float>(y) + 0.5f) / scale_;
        logarithms.push_back(std::log10(std::max(field.density(place(along, across), kAxis), 1e-30f)));
      }
    const float brightest = *std::max_element(logarithms.begin(), logarithms.end());
    for (int y = 0; y < height_; ++y)
      for (int x = 0; x < width_; ++x)
        set(x, y,
            heat(1 + (logarithms[static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x)] -
                      brightest) /
                         kDecades));
  }
  /// A dot, in mean free paths.
  void dot_at(float along, float across, const Vec3& color) {
    set(static_cast<int>(std::lround((along - left_) * scale_)),
        static_cast<int>(std::lround((top_ - across) * scale_)), color);
  }
  bool shows(float along, float across) const {
    const float x = (along - left_) * scale_, y = (top_ - across) * scale_;
    return x >= 0 && y >= 0 && x < static_cast<float>(width_) && y < static_cast<float>(height_);
  }
  float scale() const { return scale_; }
  Image take() { return std::move(image_); }

 private:
  void set(int x, int y, const Vec3& color) {
    if (x < 0 || y < 0 || x >= width_ || y >= height_) return;
    const size_t at = static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x);
    for (int c = 0; c < 3; ++c) image_.channel(static_cast<size_t>(c))[at] = color[c];
  }

  int width_, height_;
  float left_, top_, scale_;
  Image image_;
};

Canvas square_canvas(double reach, int size) {
  const auto extent = static_cast<float>(reach);
  return {size, size, -extent, extent, static_cast<float>(size) / (2 * extent)};
}

/// The cross-section of the lobe at a place.
std::vector<float> section_of(const LightField& field, const Vec3& x) {
  constexpr int kDirections = 720;
  std::vector<float> values;
  for (int i = 0; i < kDirections; ++i) {
    const float phi = 2 * kPi * static_cast<float>(i) / kDirections;
    values.push_back(field.eval(x, kAxis, place(std::cos(phi), std::sin(phi))));
  }
  return values;
}

/// Its outline, where `largest` is as long as `length`.
void draw_lobe(Canvas& canvas, const std::vector<float>& values, const Vec3& x, float largest, float length,
               const Vec3& color) {
  for (size_t i = 0; i < values.size() && largest > 0; ++i) {
    const float phi = 2 * kPi * static_cast<float>(i) / static_cast<float>(values.size());
    const float radius = std::min(length * values[i] / largest, 2 * length);
    canvas.dot_at(x.z + radius * std::cos(phi), x.x + radius * std::sin(phi), color);
  }
}

/// The direction of the optimal axis in the plane.
Vec3 axis_at(const QuadtreeField& field, float along, float across) {
  const float to_radius = field.optimal_axis({std::abs(across), along});
  const float angle = std::atan2(std::abs(across), along) + to_radius;
  return place(std::cos(angle), std::copysign(std::sin(angle), across));
}

}  // namespace

Image plot_field(const LightField& field, double reach, int size, const LightField* other) {
  Canvas canvas = square_canvas(reach, size);
  canvas.draw_density(field);
  constexpr int kLobes = 8;
  const float step = 2 * static_cast<float>(reach) / kLobes;
  for (int j = 0; j < kLobes; ++j)
    for (int i = 0; i < kLobes; ++i) {
      const Vec3 x =
          place((static_cast<float>(i) + 0.5f - kLobes / 2) * step, (kLobes / 2 - static_cast<float>(j) - 0.5f) * step);
      const std::vector<float> values = section_of(field, x);
      const float largest = *std::max_element(values.begin(), values.end());
      draw_lobe(canvas, values, x, largest, 0.45f * step, kPlotBlue);
      if (other) draw_lobe(canvas, section_of(*other, x), x, largest, 0.45f * step, kPlotGreen);
    }
  return canvas.take();
}

Image plot_axes(const QuadtreeField& field, double reach, int size) {
  Canvas canvas = square_canvas(reach, size);
  canvas.draw_density(field);
  constexpr int kLines = 20;
  const auto extent = static_cast<float>(reach);
  const float step = 0.5f / canvas.scale(), length = 2 * extent / kLines;
  for (int j = 0; j < kLines; ++j)
    for (int i = 0; i < kLines; ++i)
      for (const float way : {1.0f, -1.0f}) {
        Vec3 x = place((static_cast<float>(2 * i + 1) / kLines - 1) * extent,
                       (static_cast<float>(2 * j + 1) / kLines - 1) * extent);
        for (float done = 0; done < length && canvas.shows(x.z, x.x); done += step) {
          canvas.dot_at(x.z, x.x, kPlotBlue);
          x += axis_at(field, x.z, x.x) * (way * step);
        }
      }
  return canvas.take();
}

Image plot_cells(const QuadtreeField& field, int width) {
  const Quadtree& tree = field.tree();
  const float scale = static_cast<float>(width) / (tree.reach() - tree.behind());
  Canvas canvas(width, static_cast<int>(tree.reach() * scale), tree.behind(), tree.reach(), scale);
  canvas.draw_density(field);
  for (const Quadtree::Leaf& leaf : tree.leaves())
    for (float done = 0; done < leaf.size; done += 0.5f / scale) {
      canvas.dot_at(leaf.z + done, leaf.rho, kPlotGrey);
      canvas.dot_at(leaf.z, leaf.rho + done, kPlotGrey);
    }
  return canvas.take();
}

}  // namespace turbid
