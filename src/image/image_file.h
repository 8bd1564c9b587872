#pragma once
#include <string>
#include <vector>

#include "image/image.h"

namespace turbid {

/// How the numbers of an 8- or 16-bit file are meant.
enum class PixelEncoding {
  kColor,  ///< colours, gamma-encoded: decoded by the sRGB curve
  kData,   ///< plain numbers in [0, 1]: normals, masks, roughness; Mitsuba's raw="true"
};

/// Reads a picture file by its content and extension: EXR; PNG, JPEG, BMP, TGA, HDR. Colour becomes linear; channels
/// are R, G, B, (A) or Y, (A), for EXR whatever it has. Alpha is never decoded. A missing, damaged or unknown file
/// throws FileError.
Image read_image(const std::string& path, PixelEncoding encoding = PixelEncoding::kColor);

/// Only the named channels of an EXR file, in that order; all of them when empty.
Image read_exr(const std::string& path, const std::vector<std::string>& channels = {});

/// Writes all channels as 32-bit floats with lossless compression, the metadata as string attributes. The file appears
/// whole or not at all. Throws FileError.
void write_exr(const std::string& path, const Image& image);

/// Writes R, G, B, (A) as 8-bit sRGB after the curve of tone_map.h; `exposure` in stops multiplies by 2^exposure
/// before it. Whole or not at all. Throws FileError.
void write_png(const std::string& path, const Image& image, float exposure = 0);

}  // namespace turbid
