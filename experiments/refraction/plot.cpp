#include "plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "image/atomic_file.h"

namespace turbid::experiments {
namespace {

constexpr double kWidth = 720, kHeight = 320, kMargin = 48;

std::string csv(const std::string& x_label, const std::vector<Curve>& curves) {
  std::string text = x_label;
  for (const Curve& curve : curves) text += "," + curve.name;
  text += "\n";
  for (size_t i = 0; i < curves.front().x.size(); ++i) {
    text += fmt::format("{:g}", curves.front().x[i]);
    for (const Curve& curve : curves) text += fmt::format(",{:g}", curve.y[i]);
    text += "\n";
  }
  return text;
}

std::string svg(const std::string& title, const std::string& x_label, const std::vector<Curve>& curves) {
  double right = 0, top = 0;
  for (const Curve& curve : curves) {
    right = std::max(right, *std::max_element(curve.x.begin(), curve.x.end()));
    top = std::max(top, *std::max_element(curve.y.begin(), curve.y.end()));
  }
  const auto px = [&](double x) { return kMargin + x / right * (kWidth - 2 * kMargin); };
  const auto py = [&](double y) { return kHeight - kMargin - y / top * (kHeight - 2 * kMargin); };
  std::string text = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" font-family=\"sans-serif\" "
      "font-size=\"12\">\n<rect width=\"{0}\" height=\"{1}\" fill=\"white\"/>\n<path d=\"M{2} {2}V{3}H{4}\" "
      "fill=\"none\" stroke=\"black\"/>\n",
      kWidth, kHeight, kMargin, kHeight - kMargin, kWidth - kMargin);
  const auto label = [&](double x, double y, const std::string& what, const char* anchor, const char* color = "black") {
    text += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" fill=\"{}\">{}</text>\n", x, y, anchor,
                        color, what);
  };
  label(kWidth / 2, 20, title, "middle");
  label(kWidth / 2, kHeight - 10, x_label, "middle");
  label(kMargin, kHeight - kMargin + 16, "0", "middle");
  label(kWidth - kMargin, kHeight - kMargin + 16, fmt::format("{:.3g}", right), "middle");
  label(kMargin - 4, kMargin + 4, fmt::format("{:.3g}", top), "end");
  constexpr std::array kColors = {"#1b6ca8", "#d1495b", "#2e8b57", "#8a5a00"};
  for (size_t k = 0; k < curves.size(); ++k) {
    const char* color = kColors[k % kColors.size()];
    text += fmt::format("<polyline fill=\"none\" stroke=\"{}\" points=\"", color);
    for (size_t i = 0; i < curves[k].x.size(); ++i)
      text += fmt::format("{:.2f},{:.2f} ", px(curves[k].x[i]), py(curves[k].y[i]));
    text += "\"/>\n";
    label(kWidth - kMargin, 36 + 14 * static_cast<double>(k), curves[k].name, "end", color);
  }
  return text + "</svg>\n";
}

}  // namespace

void write_plot(const std::string& name, const std::string& title, const std::string& x_label,
                const std::vector<Curve>& curves) {
  write_file_atomically(name + ".csv", csv(x_label, curves));
  write_file_atomically(name + ".svg", svg(title, x_label, curves));
}

}  // namespace turbid::experiments
