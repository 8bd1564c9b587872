#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "experiment/score.h"
#include "image/image.h"

namespace turbid {

/// The finished runs of an experiment: one file each, with what the run depends on, and the image of the first seed; or
/// what its program printed.
class RunStore {
 public:
  /// `folder`: runs/ is made in it, and images/ where it is asked for.
  explicit RunStore(std::string folder);

  /// The run, if it is there, whole, and of this fingerprint.
  std::optional<Curve> find(const std::string& name, uint64_t fingerprint) const;
  void keep(const std::string& name, uint64_t fingerprint, const Curve& curve) const;
  std::optional<std::string> find_text(const std::string& name, uint64_t fingerprint) const;
  void keep_text(const std::string& name, uint64_t fingerprint, const std::string& text) const;
  std::string image_path(const std::string& name) const;

 private:
  std::string run_path(const std::string& name) const;
  std::string folder_;
};

}  // namespace turbid
