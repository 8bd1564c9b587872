#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "experiment/score.h"
#include "image/image.h"

namespace turbid {

/// The finished runs of an experiment: one file each, with what the run depends on, and the image of the first seed.
class RunStore {
 public:
  /// `folder`: runs/ and images/ are made in it.
  explicit RunStore(std::string folder);

  /// The run, if it is there, whole, and of this fingerprint.
  std::optional<Curve> find(const std::string& name, uint64_t fingerprint) const;
  void keep(const std::string& name, uint64_t fingerprint, const Curve& curve) const;
  std::string image_path(const std::string& name) const;

 private:
  std::string run_path(const std::string& name) const;
  std::string folder_;
};

}  // namespace turbid
