#include "core/error.h"

#include <fstream>

namespace turbid {
namespace {

std::string quoted_line(const SourceLocation& where) {
  std::ifstream file(where.file);
  std::string line;
  for (int i = 0; i < where.line; ++i)
    if (!std::getline(file, line)) return {};
  if (line.ends_with('\r')) line.pop_back();
  constexpr size_t kLongestLine = 160;
  if (where.line == 0 || line.size() > kLongestLine) return {};
  for (char& c : line)
    if (c == '\t') c = ' ';
  const auto caret = static_cast<size_t>(where.column > 0 ? where.column - 1 : 0);
  return "\n  | " + line + (where.column > 0 ? "\n  | " + std::string(caret, ' ') + "^" : "");
}

std::string located(const SourceLocation& where, const std::string& message) {
  if (where.file.empty()) return message;
  std::string place = where.file;
  if (where.line > 0) place += ":" + std::to_string(where.line);
  if (where.line > 0 && where.column > 0) place += ":" + std::to_string(where.column);
  return place + ": " + message + quoted_line(where);
}

}  // namespace

SceneError::SceneError(const SourceLocation& where, const std::string& message)
    : Error(located(where, message), 3), where_(where), reason_(message) {}

}  // namespace turbid
