#pragma once
#include <string_view>

namespace turbid {

/// Messages to people go to standard error; standard output carries only what a command was asked to print.
enum class LogLevel { kQuiet, kWarnings, kNotices };

void set_log_level(LogLevel level);
/// Something a user should know although nothing is wrong ("parameter x has no effect here").
void log_notice(std::string_view message);
/// Something is probably not what the user meant.
void log_warning(std::string_view message);

}  // namespace turbid
