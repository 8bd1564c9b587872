// What experiments may say, and what is answered to mistakes.
#include "experiment/experiment_file.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/log.h"
#include "small_experiment.h"

namespace turbid {
namespace {

using testing::ExperimentFolder;
using testing::small_experiment;
using Json = nlohmann::ordered_json;

TEST(ExperimentFile, SaysWhatToDo) {
  const ExperimentFolder folder;
  const Experiment e = folder.read();
  EXPECT_EQ(e.name, "small");
  EXPECT_EQ(e.title, "Two kinds of paths");
  EXPECT_EQ(e.rule.equal, EqualBy::kSamples);
  EXPECT_EQ(e.rule.samples, 8u);
  EXPECT_EQ(e.seeds, 3);
  ASSERT_EQ(e.scenes.size(), 1u);
  EXPECT_EQ(e.scenes[0].file, folder.file("fog.xml"));
  EXPECT_EQ(e.scenes[0].definitions, std::vector<std::string>{"density=2"});
  EXPECT_EQ(e.scenes[0].reference.integrator, "volpath");
  ASSERT_EQ(e.methods.size(), 2u);
  EXPECT_EQ(e.published[0].from, "S9 Fig. 1");
  EXPECT_DOUBLE_EQ(e.declared_seconds(0.5), 0.5 * (0.2 + 2 * 3 * 60));
  EXPECT_NO_THROW(check_experiment(e, ""));
}

/// The message for a changed experiment, without the name of the file before it.
std::string message_for(const std::function<void(Json&)>& change, const std::string& size = "") {
  Json json = small_experiment();
  change(json);
  const ExperimentFolder folder(json);
  try {
    check_experiment(folder.read(), size);
  } catch (const Error& error) {
    const std::string message = error.what();
    EXPECT_TRUE(message.starts_with(folder.path() + ": ")) << message;
    return message.substr(std::min(message.size(), folder.path().size() + 2));
  }
  return "";
}

TEST(ExperimentFile, SaysWhatIsWrong) {
  set_log_level(LogLevel::kQuiet);
  EXPECT_EQ(message_for([](Json&) {}), "");
  EXPECT_EQ(message_for([](Json& j) { j.erase("title"); }), "'title' is missing");
  EXPECT_EQ(message_for([](Json& j) { j["titel"] = "x"; }), "unknown name 'titel', did you mean 'title'?");
  EXPECT_EQ(message_for([](Json& j) { j["methods"][1]["integrater"] = "x"; }),
            "methods[1]: unknown name 'integrater', did you mean 'integrator'?");
  EXPECT_EQ(message_for([](Json& j) { j["methods"][0]["integrator"] = 3; }),
            "methods[0].integrator: expected a text, found 3");
  EXPECT_EQ(message_for([](Json& j) { j["compare"]["by"] = "equal tme"; }),
            "compare.by: unknown rule 'equal tme', did you mean 'equal time'?");
  EXPECT_EQ(message_for([](Json& j) { j["compare"]["seconds"] = -1; }),
            "compare.seconds: expected a number above 0, found -1");
  EXPECT_EQ(message_for([](Json& j) { j["compare"]["error"] = 0.1; }),
            "compare: unknown name 'error' (expected one of: by, samples, seconds)");
  EXPECT_EQ(message_for([](Json& j) { j["seeds"] = 1; }),
            "seeds: expected at least 2: uncertainties come from repeated seeds");
  EXPECT_EQ(message_for([](Json& j) { j["seeds"] = 2.5; }), "seeds: expected a whole number from 1 on, found 2.5");
  EXPECT_EQ(message_for([](Json& j) { j["scenes"] = Json::array(); }), "scenes: needs at least one");
  EXPECT_EQ(message_for([](Json& j) { j["methods"] = "volpath"; }), "methods: expected a list, found \"volpath\"");
  EXPECT_EQ(message_for([](Json& j) { j["methods"][0]["name"] = "light-tracing"; }),
            "methods: two have the same name (as a file: 'light-tracing')");
  EXPECT_EQ(message_for([](Json& j) { j.erase("reference"); }), "scenes[0]: 'reference' is missing");
  EXPECT_EQ(message_for([](Json& j) { j["published"][0]["over"] = "path"; }),
            "published[0].over: unknown over 'path', did you mean 'paths'?");
  EXPECT_EQ(message_for([](Json& j) { j["published"][0]["measure"] = "rms"; }),
            "published[0].measure: unknown measure 'rms', did you mean 'rmse'?");
  EXPECT_EQ(message_for([](Json& j) { j["baseline"] = "path"; }),
            "baseline: unknown baseline 'path', did you mean 'paths'?");
  const Json pair = {{"method", "paths"}, {"against", "Light tracing!"}};
  EXPECT_EQ(message_for([&](Json& j) { j["pairs"] = Json::array({pair}); }), "");
  EXPECT_EQ(message_for([&](Json& j) {
              j["pairs"] = Json::array({pair});
              j["pairs"][0]["against"] = "path";
            }),
            "pairs[0].against: unknown against 'path', did you mean 'paths'?");
  EXPECT_EQ(message_for([&](Json& j) {
              j["pairs"] = Json::array({pair});
              j["compare"] = {{"by", "equal time"}, {"seconds", 1}};
            }),
            "pairs: pictures have noise in common only when compared by equal samples");
  EXPECT_NE(message_for([](Json& j) { j["scenes"][0]["file"] = "frog.xml"; }).find("scenes[0].file: there is no scene"),
            std::string::npos);
}

TEST(ExperimentFile, FindsWhatCannotBeRenderedBeforeRendering) {
  set_log_level(LogLevel::kQuiet);
  EXPECT_EQ(
      message_for([](Json& j) { j["methods"][1]["integrator"] = "ptracr"; }),
      "method 'Light tracing!' in scene 'fog': --integrator: unknown integrator 'ptracr', did you mean 'ptracer'?");
  EXPECT_NE(message_for([](Json& j) {
              j["reference"]["integrator"] = "volpath,max_deth=3";
            }).find("reference of scene 'fog': --integrator: "),
            std::string::npos);
  EXPECT_NE(message_for([](Json& j) { j["scenes"][0]["define"]["densty"] = 3; }).find("densty"), std::string::npos);
  EXPECT_NE(message_for([](Json&) {}, "12").find("--size expects WIDTHxHEIGHT"), std::string::npos);
}

TEST(ExperimentFile, SaysWhereItIsNotJson) {
  const ExperimentFolder folder;
  folder.write(std::string("{\n  \"title\": ,\n}"));
  try {
    folder.read();
    FAIL();
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("is not JSON: at line 2, column 12"), std::string::npos) << error.what();
  }
}

TEST(ExperimentFile, AProgramNeedsNoScenes) {
  const ExperimentFolder folder(Json::parse(R"({"title": "t", "program": {"name": "p", "arguments": ["a"],
    "seconds": 20, "shorter": ["b"], "shorter_seconds": 3}})"));
  const Experiment e = folder.read();
  ASSERT_TRUE(e.program);
  EXPECT_EQ(e.declared_seconds(1), 20);
  EXPECT_EQ(e.declared_seconds(0.1), 3);
}

TEST(ExperimentFile, ThoseThatShipAreRight) {
  set_log_level(LogLevel::kQuiet);
  const std::vector<Experiment> experiments = read_experiments(experiments_folder());
  EXPECT_GE(experiments.size(), 8u);
  for (const Experiment& e : experiments) EXPECT_NO_THROW(check_experiment(e, "")) << e.name;
  // All of them within an hour on two cores at a tenth of their time.
  double seconds = 0;
  for (const Experiment& e : experiments) seconds += e.declared_seconds(0.1);
  EXPECT_LE(seconds / 2, 3600);
}

TEST(ExperimentFile, NamesNearToTheRightOneAreSuggested) {
  try {
    find_experiment("importance_cachin");
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_TRUE(std::string(error.what())
                    .starts_with("unknown experiment 'importance_cachin', did you mean 'importance_caching'?"))
        << error.what();
  }
}

}  // namespace
}  // namespace turbid
