#pragma once
#include <string>
#include <vector>

#include "report/report.h"

namespace turbid {

/// The tables in a text that programs print as Markdown: a row of names between bars, a row of dashes, rows. A table's
/// title is the last line of plain text before it. Cells that are plain numbers become numbers.
std::vector<ReportTable> markdown_tables(const std::string& text);

}  // namespace turbid
