#pragma once
#include <string>

#include "image/film.h"
#include "image/image.h"

namespace turbid {

/// The mean radiance per pixel as R, G, B, and with `alpha` also A (radiance is multiplied by it already).
Image film_to_image(const Film& film, bool alpha);

/// The image with room for more channels after its own; they are 0.
Image with_channels(const Image& image, const std::vector<std::string>& more);

/// The image followed by the means of the film's layers, as channels of their names; without its cascades.
Image with_layers(const Image& image, const Film& film);

/// The unbiased variance of one sample of each pixel, (n E[x^2] - n E[x]^2)/(n - 1), 0 for n = 1. As in the references
/// of Mitsuba's render tests it is the variance of the CIE XYZ components, carried in channels R, G, B by the linear
/// map from XYZ to RGB; to_xyz() of z_test.h undoes that.
Image variance_image(const Film& film);

/// Adds what Mitsuba's `moment` integrator writes: layers NAME.X, .Y, .Z with the mean in CIE XYZ, and m2_NAME.X, .Y,
/// .Z with the mean of the squared samples. Returns the image with the layers after its own channels.
Image with_moment_layers(const Image& image, const Film& film, const std::string& name);

}  // namespace turbid
