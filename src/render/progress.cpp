#include "render/progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace turbid {
namespace {

constexpr double kRedrawSeconds = 0.1, kLineSeconds = 10;

size_t terminal_width() {
  winsize size{};
  return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

std::string bar(double fraction, size_t width) {
  const auto filled = static_cast<size_t>(std::floor(fraction * static_cast<double>(width)));
  return "[" + std::string(filled, '=') + std::string(width - filled, ' ') + "] ";
}

}  // namespace

std::optional<double> ProgressState::fraction() const {
  std::optional<double> result;
  if (target) result = *target > 0 ? static_cast<double>(samples) / static_cast<double>(*target) : 1;
  if (seconds) result = std::max(result.value_or(0), *seconds > 0 ? elapsed / *seconds : 1);
  if (result) result = std::clamp(*result, 0.0, 1.0);
  return result;
}

std::optional<double> ProgressState::remaining() const {
  std::optional<double> result;
  if (target && samples >= *target) return 0;
  if (target && samples > samples_before)
    result = elapsed * static_cast<double>(*target - samples) / static_cast<double>(samples - samples_before);
  if (seconds) result = std::min(result.value_or(INFINITY), std::max(0.0, *seconds - elapsed));
  return result;
}

std::string format_duration(double seconds) {
  if (seconds < 59.95) return fmt::format("{:.1f} s", seconds);
  const auto whole = static_cast<uint64_t>(std::llround(seconds));
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

std::string describe(const ProgressState& state) {
  std::string text;
  if (const auto fraction = state.fraction()) text += fmt::format("{:.0f} %, ", std::floor(100 * *fraction));
  text += state.target ? fmt::format("{} of {} samples per pixel", state.samples, *state.target)
                       : fmt::format("{} samples per pixel", state.samples);
  text += ", " + format_duration(state.elapsed);
  if (const auto remaining = state.remaining()) text += ", " + format_duration(*remaining) + " left";
  if (state.samples > state.samples_before && state.elapsed > 0) {
    const double rate = static_cast<double>(state.samples - state.samples_before) * state.pixels / state.elapsed;
    text += fmt::format(", {:.2f} million samples/s", rate * 1e-6);
  }
  return text;
}

ProgressBar::ProgressBar(bool quiet) : quiet_(quiet), terminal_(::isatty(STDERR_FILENO) == 1) {}
ProgressBar::~ProgressBar() { clear(); }

void ProgressBar::update(const ProgressState& state) {
  if (quiet_ || state.elapsed - last_ < (terminal_ ? kRedrawSeconds : kLineSeconds)) return;
  last_ = state.elapsed;
  std::string text = describe(state);
  if (!terminal_) {
    fmt::print(stderr, "turbid: {}\n", text);
    return;
  }
  const size_t width = terminal_width();
  const auto fraction = state.fraction();
  if (fraction && width > text.size() + 16) text = bar(*fraction, std::min<size_t>(width - text.size() - 5, 40)) + text;
  fmt::print(stderr, "\r{}\033[K", text.substr(0, width - 1));
  std::fflush(stderr);
  drawn_ = true;
}

void ProgressBar::clear() {
  if (!drawn_) return;
  fmt::print(stderr, "\r\033[K");
  std::fflush(stderr);
  drawn_ = false;
}

}  // namespace turbid
