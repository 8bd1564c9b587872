#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <regex>

#include "house/source_files.h"
#include "testing/temporary_folder.h"

namespace turbid::testing {
namespace {

const std::filesystem::path kRoot = TURBID_ROOT;
/// One file per room: the include folders that its sources are compiled with, a line each.
const std::filesystem::path kDoors = TURBID_DOORS;

/// The rooms, lower ones first: none may see one that stands behind it.
const std::vector<std::string> kRooms = {"core",    "image",      "report",    "geometry",   "texture",
                                         "surface", "medium",     "emitter",   "sensor",     "scene",
                                         "path",    "refraction", "gathering", "photon",     "manylight",
                                         "table",   "integrator", "render",    "experiment", "cli"};

bool sees(const std::string& room, const std::string& other) {
  const std::vector<std::string> folders = read_lines(kDoors / room);
  return std::any_of(folders.begin(), folders.end(), [&](const std::string& folder) {
    return !folder.empty() && std::filesystem::exists(std::filesystem::path(folder) / other);
  });
}

/// Does `text`, as a source of the room, compile?
bool compiles_in(const std::string& room, const std::string& text) {
  const TemporaryFolder folder;
  std::ofstream(folder.file("probe.cpp")) << text << "\n";
  std::string command = std::string(TURBID_COMPILER) + " -std=c++20 -fsyntax-only";
  for (const std::string& path : read_lines(kDoors / room))
    if (!path.empty()) command += " -I'" + path + "'";
  command += " '" + folder.file("probe.cpp") + "' 2>/dev/null";
  return std::system(command.c_str()) == 0;
}

TEST(Rooms, SeeTheRoomsBelow) {
  for (const std::string& room : kRooms) {
    ASSERT_FALSE(read_lines(kDoors / room).empty()) << room;
    EXPECT_TRUE(sees(room, room));
    EXPECT_TRUE(sees(room, "core"));
  }
}

TEST(Rooms, DoNotSeeTheRoomsAbove) {
  for (size_t low = 0; low < kRooms.size(); ++low)
    for (size_t high = low + 1; high < kRooms.size(); ++high)
      EXPECT_FALSE(sees(kRooms[low], kRooms[high])) << kRooms[low] << " sees " << kRooms[high];
}

TEST(Rooms, AWrongIncludeDoesNotBuild) {
  EXPECT_TRUE(compiles_in("core", "#include \"core/spectrum.h\""));
  EXPECT_FALSE(compiles_in("core", "#include \"scene/scene.h\""));
  EXPECT_TRUE(compiles_in("scene", "#include \"scene/scene.h\""));
  EXPECT_FALSE(compiles_in("scene", "#include \"integrator/integrator.h\""));
}

// The doors stop what goes through them; this stops what would climb in beside them.
TEST(Rooms, IncludeNothingByARelativePath) {
  for (const SourceFile& file : source_files(kRoot, {"src"}))
    for (const std::string& line : file.lines) {
      if (!line.starts_with("#include \"")) continue;
      const std::string name = line.substr(10, line.find('"', 10) - 10);
      const std::string room = name.substr(0, name.find('/'));
      EXPECT_TRUE(std::find(kRooms.begin(), kRooms.end(), room) != kRooms.end()) << file.path << ": " << line;
      EXPECT_EQ(name.find(".."), std::string::npos) << file.path << ": " << line;
    }
}

TEST(Rooms, AreAllNamedHere) {
  for (const auto& entry : std::filesystem::directory_iterator(kRoot / "src"))
    EXPECT_TRUE(std::find(kRooms.begin(), kRooms.end(), entry.path().filename()) != kRooms.end()) << entry.path();
}

/// The label `slow` goes by the first letters of the full name, and a suite's prefix comes first.
TEST(Files, InstantiateSlowSuitesAsSlow) {
  const std::regex slow_suite(R"(INSTANTIATE_TEST_SUITE_P\(\s*(\w+),\s*Slow)");
  for (const SourceFile& file : source_files(kRoot, {"tests"})) {
    std::string text;
    for (const std::string& line : file.lines) text += line + "\n";
    for (std::sregex_iterator found(text.begin(), text.end(), slow_suite), end; found != end; ++found)
      EXPECT_TRUE((*found)[1].str().starts_with("Slow")) << file.path << ": " << found->str();
  }
}

TEST(Files, AreShortEnoughToRead) {
  for (const SourceFile& file : source_files(kRoot, {"src", "tests", "bench", "experiments"}))
    EXPECT_LE(file.lines.size(), 600u) << file.path << " is too long: split it by ideas";
}

}  // namespace
}  // namespace turbid::testing
