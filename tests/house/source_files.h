#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace turbid::testing {

/// A source file of turbid, line by line.
struct SourceFile {
  std::string path;  ///< below the root of the checkout
  std::vector<std::string> lines;
};

std::vector<std::string> read_lines(const std::filesystem::path& path);

/// All .h and .cpp files in the named folders below root, sorted by path.
std::vector<SourceFile> source_files(const std::filesystem::path& root, const std::vector<std::string>& folders);

}  // namespace turbid::testing
