#pragma once
#include <functional>
#include <stdexcept>
#include <string>

#include "core/error.h"
#include "experiment/experiment.h"
#include "experiment/score.h"
#include "experiment/staged_scene.h"
#include "image/film.h"
#include "image/image.h"

namespace turbid {

/// Someone asked for an orderly end (Ctrl-C). What is finished is kept.
struct Interrupted : Error {
  Interrupted() : Error("interrupted; the same command goes on from here", 130) {}
};

/// A picture that others are held against.
struct Reference {
  Image image;
  ReferenceError error;
  uint64_t samples = 0;  ///< per pixel
  double wall = 0;       ///< seconds
  std::string key;       ///< names all that it depends on
  std::string version;   ///< turbid's, with its commit, when it was last rendered
  bool is_new = false;   ///< some of it was rendered now
};

struct ReferenceRequest {
  double seconds = 0;  ///< processor time of all threads; a reference that was given more before is as good
  std::string folder;  ///< of the cache
  bool anew = false;   ///< forget what the cache holds
};

/// The reference, from the cache or rendered, or rendered further: it is kept as the checkpoints of two halves with
/// seeds of their own, whose name is a hash of all they depend on (files of the scene, definitions, integrator, size,
/// version of turbid; not its commit, so that work on other parts does not cost hours: `anew` renders again). What was
/// killed goes on from the last save. Throws Interrupted, FileError, SceneError.
Reference find_reference(const StagedScene& staged, const ReferenceRequest& request);

/// The picture of two independent halves, and its own error by their difference: where a and b have n and m samples,
/// E (a - b)^2 n m / (n + m)^2 is the variance of their weighted mean, whatever samples of one half have in common.
Reference reference_of(const Film& a, const Film& b);

}  // namespace turbid
