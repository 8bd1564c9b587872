// `turbid experiment` as people type it.
#include <gtest/gtest.h>
#include <signal.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "child_process.h"
#include "image/atomic_file.h"
#include "small_scene.h"
#include "testing/temporary_folder.h"

namespace turbid {
namespace {

namespace fs = std::filesystem;
using testing::Outcome;
using testing::run_turbid;
using testing::TemporaryFolder;

class ExperimentCommand : public ::testing::Test {
 protected:
  ExperimentCommand() {
    ::setenv("TURBID_VIEWER", folder_.file("viewer.html").c_str(), 1);
    std::ofstream(folder_.file("viewer.html")) << "<p><!--report--></p>";
    testing::write_small_scene(folder_.file("small.xml"));
    write(R"("volpath", "seconds": 0.1)", 0.1);
  }
  ~ExperimentCommand() override { ::unsetenv("TURBID_VIEWER"); }

  void write(const std::string& reference, double seconds) const {
    std::ofstream(folder_.file("small.json"))
        << R"({"title": "Small", "size": "8x8", "seeds": 2, "reference": {"integrator": )" << reference
        << R"(}, "compare": {"by": "equal time", "seconds": )" << seconds
        << R"(}, "scenes": [{"name": "cloud", "file": "small.xml"}], "methods": [{"name": "a", "integrator": "volpath"},)"
        << R"( {"name": "b", "integrator": "path"}]})";
  }
  Outcome run(std::vector<std::string> more) const {
    std::vector<std::string> words = {"experiment", "--cache", folder_.file("cache")};
    words.insert(words.end(), more.begin(), more.end());
    return run_turbid(folder_.path().string(), words);
  }

  TemporaryFolder folder_;
};

TEST_F(ExperimentCommand, ListsThemWithTheirTimes) {
  const Outcome outcome = run({"--time-scale", "0.1"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_NE(outcome.output.find("importance_caching "), std::string::npos) << outcome.output;
  EXPECT_NE(outcome.output.find("of processor time at --time-scale 0.1"), std::string::npos) << outcome.output;
}

TEST_F(ExperimentCommand, WritesAReport) {
  const Outcome outcome = run({"small.json", "-o", "out", "--size", "6x6"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_EQ(outcome.output, "");
  const auto json = nlohmann::json::parse(read_file(folder_.file("out/small/results.json")));
  EXPECT_EQ(json["scenes"][0]["width"], 6);
  EXPECT_NE(json["about"]["command"].get<std::string>().find("turbid experiment --cache"), std::string::npos);
  EXPECT_FALSE(json["about"]["machine"].get<std::string>().empty());
  // `path` does not see the cloud's light: said among its shortcomings or in its error.
  EXPECT_EQ(json["scenes"][0]["methods"][0]["name"], "a");
  for (const char* name : {"report.html", "results.csv", "images/cloud-a.exr", "images/cloud-reference.exr"})
    EXPECT_TRUE(fs::exists(folder_.path() / "out/small" / name)) << name;
  const std::string page = read_file(folder_.file("out/small/report.html"));
  const auto report = nlohmann::json::parse(page.substr(3, page.rfind("</p>") - 3));
  EXPECT_EQ(report["verdicts"][0]["place"], "cloud");
}

TEST_F(ExperimentCommand, MistakesAreExplained) {
  Outcome outcome = run({"importance_cachin"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.errors.find("did you mean 'importance_caching'?"), std::string::npos) << outcome.errors;
  write(R"("volpth", "seconds": 0.1)", 0.1);
  outcome = run({"small.json"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(
      outcome.errors.find("small.json: reference of scene 'cloud': --integrator: unknown integrator 'volpth', did "
                          "you mean 'volpath'?"),
      std::string::npos)
      << outcome.errors;
  EXPECT_FALSE(fs::exists(folder_.path() / "results"));
  outcome = run({"missing.json"});
  EXPECT_EQ(outcome.exit_code, 4);
  write(R"("volpath", "seconds": 0.1)", 0.1);
  outcome = run({"small.json", "-o", "small.xml"});
  EXPECT_EQ(outcome.exit_code, 4);
  EXPECT_NE(outcome.errors.find("small.xml/small: cannot be made"), std::string::npos) << outcome.errors;
  ::setenv("TURBID_VIEWER", folder_.file("none.html").c_str(), 1);
  outcome = run({"small.json"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.errors.find("./turbid viewer"), std::string::npos) << outcome.errors;
}

TEST_F(ExperimentCommand, GoesOnAfterAnEndOfAnyKind) {
  write(R"("volpath", "seconds": 0.2)", 0.5);
  for (const int signal : {SIGINT, SIGKILL}) {
    const std::string out = "out" + std::to_string(signal);
    testing::ChildProcess child(folder_.path().string(),
                                {"experiment", "--cache", folder_.file("cache"), "small.json", "-o", out});
    const fs::path folder = folder_.path() / out / "small", first = folder / "runs/cloud-a-1.json";
    for (int i = 0; i < 6000 && !fs::exists(first); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    ASSERT_TRUE(fs::exists(first));
    child.send(signal);
    EXPECT_NE(child.wait().exit_code, 0);
    EXPECT_FALSE(fs::exists(folder / "report.html"));
    const auto before = fs::last_write_time(first);
    EXPECT_EQ(run({"small.json", "-o", out}).exit_code, 0);
    EXPECT_EQ(fs::last_write_time(first), before) << "the finished run was made again";
    EXPECT_TRUE(fs::exists(folder / "report.html"));
  }
}

}  // namespace
}  // namespace turbid
