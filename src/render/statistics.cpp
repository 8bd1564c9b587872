#include "render/statistics.h"

#include <sys/resource.h>

#include <nlohmann/json.hpp>

namespace turbid {
namespace {

double seconds_of(const timeval& t) { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); }

rusage usage() {
  rusage u{};
  ::getrusage(RUSAGE_SELF, &u);
  return u;
}

}  // namespace

double process_cpu_seconds() {
  const rusage u = usage();
  return seconds_of(u.ru_utime) + seconds_of(u.ru_stime);
}

uint64_t process_peak_memory() { return static_cast<uint64_t>(usage().ru_maxrss) * 1024; }

uint64_t RenderStatistics::counter(const std::string& name) const {
  const auto found = counters.find(name);
  return found == counters.end() ? 0 : found->second;
}

std::string to_json(const RenderStatistics& s, const std::map<std::string, std::string>& about) {
  nlohmann::ordered_json json;
  for (const auto& [name, value] : about) json[name] = value;
  json["width"] = s.size.x;
  json["height"] = s.size.y;
  json["interrupted"] = s.interrupted;
  json["wall_seconds"] = s.wall_seconds;
  json["prepare_seconds"] = s.prepare_seconds;
  json["pass_seconds"] = s.pass_seconds;
  json["cpu_seconds"] = s.cpu_seconds;
  json["passes"] = s.passes;
  json["samples_per_pixel"] = s.samples_per_pixel;
  json["samples"] = s.samples;
  json["samples_per_second"] = s.samples_per_second();
  json["rays"] = s.counter("rays") + s.counter("shadow_rays");
  json["dropped_samples"] = s.counter("dropped_samples");
  json["peak_memory_bytes"] = s.peak_memory;
  json["counters"] = s.counters;
  return json.dump(2) + "\n";
}

}  // namespace turbid
