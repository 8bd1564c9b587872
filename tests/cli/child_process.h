#pragma once
#include <map>
#include <string>
#include <vector>

namespace turbid::testing {

/// What a program that has ended left.
struct Outcome {
  int exit_code = -1;  ///< -1: ended by a signal
  int signal = 0;
  std::string output, errors;  ///< standard output and standard error
};

/// A run of the turbid program in a folder, its output collected in files there.
class ChildProcess {
 public:
  ChildProcess(const std::string& folder, const std::vector<std::string>& arguments);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  void send(int signal) const;
  bool has_ended();
  Outcome wait();

 private:
  std::string folder_;
  int pid_;
  int status_ = 0;
  bool ended_ = false;
};

/// Runs to the end.
Outcome run_turbid(const std::string& folder, const std::vector<std::string>& arguments);

}  // namespace turbid::testing
