#include "experiment/markdown_tables.h"

#include <charconv>
#include <sstream>

namespace turbid {
namespace {

std::string trimmed(const std::string& text) {
  const size_t begin = text.find_first_not_of(" \t\r"), end = text.find_last_not_of(" \t\r");
  return begin == std::string::npos ? "" : text.substr(begin, end - begin + 1);
}

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  for (size_t at = 1; at < line.size();) {
    const size_t end = std::min(line.find('|', at), line.size());
    cells.push_back(trimmed(line.substr(at, end - at)));
    at = end + 1;
  }
  return cells;
}

bool is_rule(const std::string& line) {
  return line.starts_with('|') && line.find_first_not_of("|-: ") == std::string::npos;
}

ReportTable::Cell cell_of(const std::string& text) {
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error == std::errc() && end == text.data() + text.size()) return number;
  return text;
}

}  // namespace

std::vector<ReportTable> markdown_tables(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(trimmed(line));
  std::vector<ReportTable> tables;
  std::string title;
  for (size_t i = 0; i < lines.size(); ++i) {
    if (!lines[i].starts_with('|')) {
      if (!lines[i].empty()) title = lines[i].substr(std::min(lines[i].size(), lines[i].find_first_not_of("# ")));
      continue;
    }
    if (i + 1 >= lines.size() || !is_rule(lines[i + 1])) continue;
    ReportTable table{.title = title, .columns = cells_of(lines[i]), .rows = {}};
    for (i += 2; i < lines.size() && lines[i].starts_with('|'); ++i) {
      std::vector<ReportTable::Cell> row;
      for (const std::string& cell : cells_of(lines[i])) row.push_back(cell_of(cell));
      table.rows.push_back(std::move(row));
    }
    --i;
    tables.push_back(std::move(table));
    title.clear();
  }
  return tables;
}

}  // namespace turbid
