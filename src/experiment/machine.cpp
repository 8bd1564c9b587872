#include "experiment/machine.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/utsname.h>

#include <ctime>
#include <fstream>

#include "render/threads.h"

namespace turbid {
namespace {

std::string processor_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("model name")) return line.substr(std::min(line.size(), line.find(':') + 2));
  return "unknown processor";
}

}  // namespace

std::string describe_machine() {
  utsname system{};
  ::uname(&system);
  const int threads = thread_count();
  return fmt::format("{}, {} thread{}, {} {}", processor_name(), threads, threads == 1 ? "" : "s", system.sysname,
                     system.machine);
}

std::string describe_now() { return fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(std::time(nullptr))); }

}  // namespace turbid
