// `turbid table`: what it prints, what it refuses, and two of it at once.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "child_process.h"
#include "image/image_file.h"
#include "testing/temporary_folder.h"

namespace turbid::testing {
namespace {

class Table : public ::testing::Test {
 protected:
  Outcome run(const std::vector<std::string>& words) const {
    std::vector<std::string> all = {"table", "--folder", folder_.file("tables"), "--samples", "2000"};
    all.insert(all.end(), words.begin(), words.end());
    return run_turbid(folder_.path().string(), all);
  }
  static void expect_words(const std::string& text, const std::string& words) {
    EXPECT_NE(text.find(words), std::string::npos) << words << "\n" << text;
  }
  size_t files() const {
    size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path() / "tables"))
      count += entry.is_regular_file();
    return count;
  }

  TemporaryFolder folder_;
};

TEST_F(Table, IsBuiltOnceAndReadThen) {
  const Outcome first = run({"--g", "0.3", "--albedo", "0.9", "-o", "plot.png"});
  EXPECT_EQ(first.exit_code, 0) << first.errors;
  expect_words(first.output, "built in ");
  expect_words(first.output, "mean cosine 0.3000, bands to l = 3, m = 2; 48 x 28 cells to 250 mean free paths");
  EXPECT_EQ(files(), 1u);
  const Image plot = read_image(folder_.file("plot.png"));
  const auto red = plot.channel("R");
  EXPECT_GT(*std::max_element(red.begin(), red.end()), 0.8f);
  EXPECT_LT(*std::min_element(red.begin(), red.end()), 0.5f);
  const Outcome second = run({"--g", "0.3", "--albedo", "0.9"});
  expect_words(second.output, "read in ");
  EXPECT_EQ(files(), 1u);
  // Everything below the line of times is the same.
  const auto errors = [](const std::string& text) { return text.substr(text.find("errors, %")); };
  EXPECT_EQ(errors(first.output), errors(second.output));
}

TEST_F(Table, OfTheMediaOfAScene) {
  std::ofstream(folder_.file("scene.xml"))
      << "<scene version=\"3.0.0\"><integrator type=\"volpath\"/><sensor type=\"perspective\"/>"
         "<shape type=\"sphere\"><bsdf type=\"null\"/><medium name=\"interior\" type=\"homogeneous\">"
         "<float name=\"sigma_t\" value=\"4\"/><rgb name=\"albedo\" value=\"0.9, 0.8, 0.9\"/></medium></shape>"
         "<emitter type=\"constant\"/></scene>";
  const Outcome outcome = run({"scene.xml"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  expect_words(outcome.output, "collision    0.9000");
  expect_words(outcome.output, "ray          0.8000");
}

TEST_F(Table, AsPublished) {
  const Outcome first = run({"--mode", "seed", "--photons", "2000", "--g", "0.3", "--albedo", "0.6", "-o", "plot.png"});
  EXPECT_EQ(first.exit_code, 0) << first.errors;
  expect_words(first.output, "built in ");
  expect_words(first.output, "2000 photons, orders 3 and more");
  expect_words(first.output, "collision    0.6000");
  expect_words(first.output, "segment      0.6000");
  EXPECT_EQ(files(), 2u);  // and the exact one
  for (const std::string source : {"point", "segment"})
    for (const std::string what : {"axes", "cells", "lobes", "sphere"})
      EXPECT_TRUE(std::filesystem::exists(folder_.file("plot-" + source + "-" + what + ".png"))) << source << what;
  expect_words(run({"--mode", "seed", "--photons", "2000", "--g", "0.3", "--albedo", "0.6"}).output, "read in ");
  EXPECT_EQ(run({"--mode", "other", "--g", "0.3"}).exit_code, 2);
}

TEST_F(Table, RefusesWithAdvice) {
  const Outcome narrow = run({"--g", "0.95"});
  EXPECT_EQ(narrow.exit_code, 2);
  expect_words(narrow.errors, "this phase function's peak is too narrow for a table of multiple scattering");
  EXPECT_EQ(run({"--g", "1.5"}).exit_code, 2);
  expect_words(run({"--g", "0.5", "--albedo", "1"}).errors, "--albedo must lie between 0 and 0.9995, 1 does not");
}

TEST_F(Table, TwoProcessesAtOnceBothSucceed) {
  const std::vector<std::string> words = {"table", "--g", "0", "--samples", "2000", "--folder", folder_.file("tables")};
  std::filesystem::create_directory(folder_.path() / "a");
  std::filesystem::create_directory(folder_.path() / "b");
  ChildProcess a((folder_.path() / "a").string(), words), b((folder_.path() / "b").string(), words);
  EXPECT_EQ(a.wait().exit_code, 0);
  EXPECT_EQ(b.wait().exit_code, 0);
  EXPECT_EQ(files(), 1u);
}

}  // namespace
}  // namespace turbid::testing
