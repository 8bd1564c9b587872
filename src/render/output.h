#pragma once
#include <optional>
#include <string>
#include <vector>

#include "image/cascades.h"
#include "image/image.h"

namespace turbid {

/// Which files a render writes, and what they say.
struct OutputSettings {
  std::string path;         ///< of the image, ends in .exr; empty: nothing is written
  bool png = true;          ///< a tone-mapped picture beside it
  float exposure = 0;       ///< of the PNG, in stops
  bool alpha = false;       ///< an alpha channel
  bool variance = false;    ///< per-sample variance in NAME_var.exr (see variance_image)
  std::string moment_name;  ///< not empty: the layers of Mitsuba's `moment` integrator under this name
  std::optional<OutlierSettings> outliers{};  ///< take outliers from the picture (see reject_outliers)
  Vec2i crop_offset{0, 0};                    ///< of the first pixel on the whole film
  Vec2i film_size{0, 0};                      ///< of the whole film; 0: no crop
  bool tells_passes = true;                   ///< their number is added, too
  Metadata metadata;  ///< scene, command, version, integrator, seed; passes, samples, seconds are added

  std::string png_path() const;
  std::string variance_path() const;
  std::string checkpoint_path() const;
};

/// Writes all files of a render, each in one step, and returns their names. Throws FileError.
std::vector<std::string> write_output(const OutputSettings& settings, const Film& film, double seconds);

/// Throws FileError when one of the files could not be written: before the work, not after.
void check_output(const OutputSettings& settings);

}  // namespace turbid
