// Experiments that are programs: how they are run, and what becomes of what they print.
#include "experiment/program_figure.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "core/error.h"
#include "experiment/reference.h"
#include "experiment/run_store.h"
#include "testing/temporary_folder.h"

namespace turbid {
namespace {

namespace fs = std::filesystem;

class ProgramFigure : public ::testing::Test {
 protected:
  ProgramFigure() {
    fs::create_directories(folder_.path() / "experiments");
    ::setenv("TURBID_PROGRAMS", folder_.path().c_str(), 1);
    experiment_.file = folder_.file("experiments/figure.json");
    experiment_.title = "A figure";
    experiment_.program = ProgramSettings{.name = "turbid_figure",
                                          .arguments = {"two words", "x"},
                                          .seconds = 10,
                                          .shorter = {"short"},
                                          .shorter_seconds = 1};
  }
  ~ProgramFigure() override { ::unsetenv("TURBID_PROGRAMS"); }

  void write_program(const std::string& script) const {
    const std::string path = folder_.file("turbid_figure");
    std::ofstream(path) << "#!/bin/sh\n" << script;
    fs::permissions(path, fs::perms::owner_all);
  }

  testing::TemporaryFolder folder_;
  Experiment experiment_;
};

TEST_F(ProgramFigure, IsWhatItPrints) {
  write_program("printf '| a | %s |\\n| --- | --- |\\n| 1 | %s |\\n' \"$#\" \"$1\"\nls experiments >&2; exit 0\n");
  const std::string printed = run_program_figure(experiment_, 1);
  EXPECT_EQ(printed, "| a | 2 |\n| --- | --- |\n| 1 | two words |\n");
  const Report report = report_of(experiment_, printed, {{"command", "c"}});
  ASSERT_EQ(report.tables.size(), 1u);
  EXPECT_EQ(std::get<std::string>(report.tables[0].rows[0][1]), "two words");
  EXPECT_EQ(run_program_figure(experiment_, 0.5), "| a | 1 |\n| --- | --- |\n| 1 | short |\n");
  EXPECT_EQ(program_line(experiment_, 0.5), "turbid_figure short");
}

/// What was printed is found again, unless the program or its arguments have changed.
TEST_F(ProgramFigure, IsMadeOnce) {
  EXPECT_THROW(program_fingerprint(experiment_, 1), UsageError);
  write_program("echo one\n");
  const uint64_t key = program_fingerprint(experiment_, 1);
  EXPECT_EQ(program_fingerprint(experiment_, 1), key);
  EXPECT_NE(program_fingerprint(experiment_, 0.5), key);
  const RunStore store(folder_.file("results"));
  EXPECT_FALSE(store.find_text("figure", key));
  store.keep_text("figure", key, "| \"a\" |\n");
  EXPECT_EQ(store.find_text("figure", key), "| \"a\" |\n");
  EXPECT_FALSE(store.find("figure", key)) << "no curve";
  write_program("echo two\n");
  EXPECT_FALSE(store.find_text("figure", program_fingerprint(experiment_, 1)));
  std::ofstream(folder_.file("results/runs/figure.json")) << "{";
  EXPECT_FALSE(store.find_text("figure", key)) << "damaged";
}

TEST_F(ProgramFigure, RunsAboveTheFolderOfTheExperiments) {
  write_program("pwd\n");
  EXPECT_EQ(run_program_figure(experiment_, 1), fs::canonical(folder_.path()).string() + "\n");
}

TEST_F(ProgramFigure, ThatFailsOrIsNotThereIsAnError) {
  EXPECT_THROW(run_program_figure(experiment_, 1), UsageError);
  write_program("echo '| half |'; exit 3\n");
  try {
    run_program_figure(experiment_, 1);
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "turbid_figure failed");
  }
}

TEST_F(ProgramFigure, ThatIsInterruptedIsAnInterruption) {
  write_program("kill -INT $$\n");
  EXPECT_THROW(run_program_figure(experiment_, 1), Interrupted);
}

}  // namespace
}  // namespace turbid
