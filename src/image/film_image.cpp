#include "image/film_image.h"

#include <algorithm>

#include "image/cascades.h"
#include "image/color.h"

namespace turbid {
namespace {

/// Means of one pixel in CIE XYZ: of a sample and of its square.
struct XyzMoments {
  double mean[3] = {}, second[3] = {};
};

XyzMoments xyz_moments(const PixelSums& sums, double samples) {
  XyzMoments moments;
  for (int i = 0; i < 3; ++i) {
    const double* m = kRgbToXyz[i];
    for (int c = 0; c < kChannels; ++c) {
      const int next = (c + 1) % kChannels;
      moments.mean[i] += m[c] * sums.radiance[c];
      moments.second[i] += m[c] * m[c] * sums.squares[c] + 2 * m[c] * m[next] * sums.products[c];
    }
    moments.mean[i] /= samples;
    moments.second[i] /= samples;
  }
  return moments;
}

double sample_count(const Film& film) { return static_cast<double>(std::max<uint64_t>(film.samples(), 1)); }

}  // namespace

Image with_channels(const Image& image, const std::vector<std::string>& more) {
  std::vector<std::string> names = image.channel_names();
  names.insert(names.end(), more.begin(), more.end());
  Image result(image.width(), image.height(), std::move(names));
  result.offset = image.offset;
  result.full_size = image.full_size;
  result.metadata = image.metadata;
  for (size_t c = 0; c < image.channel_count(); ++c) std::ranges::copy(image.channel(c), result.channel(c).begin());
  return result;
}

Image film_to_image(const Film& film, bool alpha) {
  std::vector<std::string> names{"R", "G", "B"};
  if (alpha) names.emplace_back("A");
  Image image(film.size().x, film.size().y, std::move(names));
  const double n = sample_count(film);
  for (size_t i = 0; i < film.pixel_count(); ++i) {
    for (int c = 0; c < kChannels; ++c)
      image.channel(static_cast<size_t>(c))[i] = static_cast<float>(film.pixel(i).radiance[c] / n);
    if (alpha) image.channel(size_t{3})[i] = static_cast<float>(film.pixel(i).alpha / n);
  }
  return image;
}

Image with_layers(const Image& image, const Film& film) {
  const size_t first = image.channel_count();
  std::vector<std::string> names = film.layer_names();
  std::erase_if(names, Cascades::is_cascade);  // they are the last ones
  Image result = with_channels(image, names);
  const double n = sample_count(film);
  for (size_t c = 0; c < names.size(); ++c)
    for (size_t i = 0; i < film.pixel_count(); ++i)
      result.channel(first + c)[i] = static_cast<float>(film.layers(i)[c] / n);
  return result;
}

Image variance_image(const Film& film) {
  Image image(film.size().x, film.size().y, {"R", "G", "B"});
  const double n = sample_count(film);
  const double bessel = n > 1 ? n / (n - 1) : 0;
  for (size_t i = 0; i < film.pixel_count(); ++i) {
    const XyzMoments moments = xyz_moments(film.pixel(i), n);
    double variance[3];
    for (int c = 0; c < 3; ++c)
      variance[c] = bessel * std::max(0.0, moments.second[c] - moments.mean[c] * moments.mean[c]);
    for (size_t c = 0; c < 3; ++c) {
      const double* m = kXyzToRgb[c];
      image.channel(c)[i] = static_cast<float>(m[0] * variance[0] + m[1] * variance[1] + m[2] * variance[2]);
    }
  }
  return image;
}

Image with_moment_layers(const Image& image, const Film& film, const std::string& name) {
  std::vector<std::string> names;
  for (const std::string& prefix : {name, "m2_" + name})
    for (const char* component : {".X", ".Y", ".Z"}) names.push_back(prefix + component);
  const size_t first = image.channel_count();
  Image result = with_channels(image, names);
  const double n = sample_count(film);
  for (size_t i = 0; i < film.pixel_count(); ++i) {
    const XyzMoments moments = xyz_moments(film.pixel(i), n);
    for (size_t c = 0; c < 3; ++c) {
      result.channel(first + c)[i] = static_cast<float>(moments.mean[c]);
      result.channel(first + 3 + c)[i] = static_cast<float>(moments.second[c]);
    }
  }
  return result;
}

}  // namespace turbid
