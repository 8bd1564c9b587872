#pragma once

namespace turbid {

/// While it lives, signals become requests instead of ending the process: SIGINT (Ctrl-C) and SIGTERM ask for an
/// orderly end, SIGHUP for the image as it is. A second SIGINT or SIGTERM ends the process at once with exit code 130.
/// What was ignored when the process began (SIGINT of a background job) stays ignored. One at a time; the old handlers
/// come back at its end.
class SignalGuard {
 public:
  SignalGuard();
  ~SignalGuard();
  SignalGuard(const SignalGuard&) = delete;
  SignalGuard& operator=(const SignalGuard&) = delete;

  /// An orderly end was asked for.
  bool interrupted() const;
  /// The image was asked for since the last call.
  bool take_image_request();
};

}  // namespace turbid
