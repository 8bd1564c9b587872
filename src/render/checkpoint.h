#pragma once
#include <cstdint>
#include <string>

#include "image/film.h"

namespace turbid {

/// What a render needs to go on later: the sums over its whole passes.
struct Checkpoint {
  /// A hash of everything that the image depends on: contents of the scene's files, overrides, integrator, size, seed,
  /// version of turbid. Not of the budget or the number of threads.
  uint64_t fingerprint = 0;
  double seconds = 0;  ///< wall time spent rendering so far
  Film film;
};

/// Replaces the file in one step (see write_file_atomically). Throws FileError.
void write_checkpoint(const std::string& path, uint64_t fingerprint, double seconds, const Film& film);

/// Throws FileError when the file cannot be read, is no checkpoint, has another format version, or is damaged.
Checkpoint read_checkpoint(const std::string& path);

/// True when the file begins like a checkpoint of any format, damaged or not.
bool looks_like_checkpoint(const std::string& path);

}  // namespace turbid
