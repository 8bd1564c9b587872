#include "core/log.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

namespace turbid {
namespace {
spdlog::logger& logger() {
  static const std::shared_ptr<spdlog::logger> instance = [] {
    auto made = std::make_shared<spdlog::logger>("turbid", std::make_shared<spdlog::sinks::stderr_color_sink_mt>());
    made->set_pattern("turbid: %^%v%$");
    return made;
  }();
  return *instance;
}
}  // namespace

void set_log_level(LogLevel level) {
  logger().set_level(level == LogLevel::kNotices    ? spdlog::level::info
                     : level == LogLevel::kWarnings ? spdlog::level::warn
                                                    : spdlog::level::off);
}
void log_notice(std::string_view message) { logger().info(message); }
void log_warning(std::string_view message) { logger().warn("warning: {}", message); }

}  // namespace turbid
