#pragma once
#include <cstdint>
#include <optional>
#include <string>

namespace turbid {

/// How far a render is.
struct ProgressState {
  uint64_t samples = 0;              ///< per pixel
  std::optional<uint64_t> target{};  ///< samples per pixel at the end
  std::optional<double> seconds{};   ///< wall time at the end
  double elapsed = 0;                ///< of this run
  uint64_t samples_before = 0;       ///< per pixel, made by earlier runs
  double pixels = 0;

  /// Share done in [0, 1]; empty when there is no end.
  std::optional<double> fraction() const;
  /// Estimate of the seconds that are left; empty when nothing is known.
  std::optional<double> remaining() const;
};

/// "3.2 s", "4 min 05 s", "2 h 07 min".
std::string format_duration(double seconds);
/// The state as a line without a bar: "37 %, 24 of 64 samples per pixel, 12.3 s, 20.9 s left".
std::string describe(const ProgressState& state);

/// Shows progress on standard error: a bar that is redrawn on a terminal, else a line every ten seconds.
class ProgressBar {
 public:
  explicit ProgressBar(bool quiet);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// Called often; draws when it is time to.
  void update(const ProgressState& state);
  /// Removes the bar so that other lines can follow.
  void clear();

 private:
  bool quiet_, terminal_;
  bool drawn_ = false;
  double last_ = 0;
};

}  // namespace turbid
