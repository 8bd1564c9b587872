// What the program says and returns for right and wrong words.
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>

#include "child_process.h"
#include "small_scene.h"
#include "testing/temporary_folder.h"

namespace turbid {
namespace {

using testing::Outcome;
using testing::run_turbid;
using testing::TemporaryFolder;

class Usage : public ::testing::Test {
 protected:
  Outcome run(const std::vector<std::string>& arguments) const {
    return run_turbid(folder_.path().string(), arguments);
  }
  void expect_error(const std::vector<std::string>& arguments, int code, const std::string& message) const {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, code) << outcome.errors;
    EXPECT_NE(outcome.errors.find(message), std::string::npos) << outcome.errors;
    EXPECT_EQ(outcome.output, "");
  }

  TemporaryFolder folder_;
};

TEST_F(Usage, VersionAndHelp) {
  EXPECT_TRUE(run({"--version"}).output.starts_with("turbid 0."));
  EXPECT_EQ(run({"--version"}).exit_code, 0);
  EXPECT_NE(run({"--help"}).output.find("render"), std::string::npos);
  EXPECT_NE(run({"render", "--help"}).output.find("--resume"), std::string::npos);
}

TEST_F(Usage, WrongWordsAreExitCode2) {
  expect_error({}, 2, "render");
  expect_error({"rendr"}, 2, "turbid: unknown command 'rendr', did you mean 'render'?");
  expect_error({"render", "--ssp", "3"}, 2, "turbid: unknown option '--ssp', did you mean '--spp'?");
  expect_error({"render", "--spp", "0"}, 2, "--spp");
  expect_error({"render", "--spp", "many"}, 2, "--spp");
  expect_error({"render", "--spp", "1", "--time", "3"}, 2, "--time");
  expect_error({"render", "--size", "64"}, 2, "--size expects WIDTHxHEIGHT in pixels, such as 640x480, found '64'");
  expect_error({"render", "--size", "0x64"}, 2, "--size expects");
  expect_error({"render", "-o", "picture.jpg"}, 2, "-o expects a name that ends in .exr, found 'picture.jpg'");
  expect_error({"render", "-D", "spp"}, 2, "-D expects name=value, found 'spp'");
  expect_error({"render", "--integrator", "volpth"}, 2, "did you mean 'volpath'?");
  expect_error({"render", "--integrator", "volpath,max_deth=3"}, 2, "did you mean 'max_depth'?");
  expect_error({"compare", "a.exr"}, 2, "REFERENCE");
  expect_error({"list", "bsdf"}, 2, "did you mean 'bsdfs'?");
  expect_error({"list", "bsdfs", "difuse"}, 2, "did you mean 'diffuse'?");
}

TEST_F(Usage, SceneErrorsAreExitCode3AndFileErrors4) {
  std::ofstream(folder_.file("wrong.xml")) << "<scene version=\"3.0.0\">\n  <shape type=\"spere\"/>\n</scene>\n";
  expect_error({"render", "wrong.xml"}, 3, "wrong.xml:2");
  expect_error({"info", "wrong.xml"}, 3, "did you mean 'sphere'?");
  expect_error({"render", "missing.xml"}, 4, "missing.xml");
  expect_error({"compare", "a.exr", "b.exr"}, 4, "a.exr: cannot be opened");
  testing::write_small_scene(folder_.file("small.xml"));
  expect_error({"render", "small.xml", "-o", "no/folder.exr"}, 4, "no/folder.exr: cannot be written");
  expect_error({"render", "small.xml", "--json", "no/folder.json"}, 4, "no/folder.json: cannot be written");
}

TEST_F(Usage, ListsCategoriesPluginsAndParameters) {
  const std::string categories = run({"list"}).output;
  for (const char* word : {"integrators", "bsdfs", "media", "phases", "materials", "emitters", "shapes", "volpath"})
    EXPECT_NE(categories.find(word), std::string::npos) << word;
  EXPECT_NE(run({"list", "integrators"}).output.find("moment"), std::string::npos);
  EXPECT_NE(run({"list", "integrators", "volpathmis"}).output.find("max_depth"), std::string::npos);
  EXPECT_NE(run({"list", "bsdfs", "roughdielectric"}).output.find("alpha"), std::string::npos);
  EXPECT_GT(run({"list", "materials"}).output.size(), 100u);
  EXPECT_NE(run({"list", "materials", "S1 Wax"}).output.find("sigma_s"), std::string::npos);
}

TEST_F(Usage, InfoDescribesAScene) {
  testing::write_small_scene(folder_.file("small.xml"));
  const Outcome outcome = run({"info", "small.xml", "--size", "64x32"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  for (const char* words :
       {"moment(volpath max_depth=6)", "64 x 32 pixels; 16 samples per pixel", "1 sphere", "cloud",
        "mean free path (0.5, 1, 2) scene units, (0.25, 0.5, 1) of its extent (2), albedo (0.9, 0.8, 0.7)",
        "1 constant", "memory"})
    EXPECT_NE(outcome.output.find(words), std::string::npos) << words << "\n" << outcome.output;
  EXPECT_EQ(run({"info"}).exit_code, 0);  // the default scene
}

TEST_F(Usage, StartsQuickly) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers start slowly";
#endif
  double best = 1;
  for (int i = 0; i < 10; ++i) {
    const auto start = std::chrono::steady_clock::now();
    run({"list"});
    best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  EXPECT_LT(best, 0.05);
}

}  // namespace
}  // namespace turbid
