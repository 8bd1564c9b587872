// What the files of results say.
#include "experiment/results.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "experiment/markdown_tables.h"
#include "experiment/relations.h"
#include "experiment/results_page.h"

namespace turbid {
namespace {

/// A method whose error at the end is `rmse` within a hundredth, of two seeds.
MethodResult method_of(const std::string& name, double rmse, double seconds, double own_mse) {
  MethodResult made;
  made.method = {name, "volpath"};
  made.command = "turbid render fog.xml";
  made.image = Image(2, 2, {"R", "G", "B"});
  for (const double factor : {0.99, 1.01})
    made.runs.push_back({{seconds / 2, seconds / 4, 4, 0, {2 * factor * rmse * rmse + own_mse, 0.2, 1}},
                         {seconds, seconds / 2, 8, 1, {factor * rmse * rmse + own_mse, 0.1, 1}}});
  ReferenceError reference{.mse = {own_mse, 0}, .mean = 0.5, .peak = 2};
  made.score = score_of(made.runs, reference, 0);
  return made;
}

ExperimentResult example() {
  ExperimentResult result;
  Experiment& e = result.experiment;
  e.name = "small";
  e.title = "An \"example\"";
  e.figure = "S9 Fig. 1";
  e.seeds = 2;
  e.rule = result.rule = {.equal = EqualBy::kTime, .seconds = 10};
  e.published = {{"fog", "slow", "fast", "rmse", 4, "S9"},
                 {"fog", "fast", "", "psnr", 30, "S9"},
                 {"fog", "slow", "", "seconds to error", 3, "S9"}};
  SceneResult& scene = result.scenes.emplace_back();
  scene.scene.name = "fog";
  scene.reference.image = Image(2, 2, {"R", "G", "B"});
  scene.reference.error = {.mse = {1e-4, 1e-6}, .mean = 0.5, .peak = 2};
  scene.methods = {method_of("slow", 0.2, 10, 1e-4), method_of("fast", 0.1, 10, 1e-4),
                   method_of("as fast", 0.1001, 10, 1e-4)};
  return result;
}

void expect_estimate(const nlohmann::ordered_json& json, double value, double tolerance) {
  ASSERT_TRUE(json.is_object());
  EXPECT_NEAR(json.at("value").get<double>(), value, tolerance);
  EXPECT_TRUE(json.at("error").is_number());
}

TEST(Results, HaveTheirSchema) {
  const auto json = nlohmann::ordered_json::parse(to_json(example(), {{"command", "turbid experiment small"}}).dump());
  EXPECT_EQ(json.at("format"), 1);
  for (const char* name : {"experiment", "title", "figure"}) EXPECT_TRUE(json.at(name).is_string()) << name;
  EXPECT_EQ(json.at("compare").at("by"), "equal time");
  EXPECT_EQ(json.at("compare").at("seconds"), 10);
  EXPECT_EQ(json.at("seeds"), 2);
  EXPECT_EQ(json.at("about").at("command"), "turbid experiment small");
  ASSERT_EQ(json.at("scenes").size(), 1u);
  const auto& scene = json["scenes"][0];
  EXPECT_EQ(scene.at("width"), 2);
  expect_estimate(scene.at("reference").at("mse"), 1e-4, 1e-12);
  for (const char* name : {"integrator", "samples", "wall_seconds", "key", "mean", "peak", "mse_by_variance"})
    EXPECT_TRUE(scene["reference"].contains(name)) << name;
  ASSERT_EQ(scene.at("methods").size(), 3u);
  const auto& best = scene["methods"][0];
  EXPECT_EQ(best.at("name"), "fast");
  EXPECT_EQ(best.at("rank"), 1);
  expect_estimate(best.at("rmse"), 0.1, 1e-3);
  expect_estimate(best.at("relative_rmse"), 0.2, 2e-3);
  expect_estimate(best.at("psnr"), 20 * std::log10(20), 0.1);
  expect_estimate(best.at("cost"), 0.1, 1e-3);
  for (const char* name : {"rel_mse", "mean_ratio", "seconds", "samples"})
    EXPECT_TRUE(best.at(name).is_object()) << name;
  EXPECT_TRUE(best.at("seconds_to_error").is_null());
  EXPECT_NEAR(best.at("slope").get<double>(), -0.5, 0.01);
  ASSERT_EQ(best.at("curve").size(), 2u);
  for (const char* name : {"seconds", "samples", "rmse", "rmse_error"})
    EXPECT_TRUE(best["curve"][0].at(name).is_number()) << name;
}

TEST(Results, StandBesideWhatWasPublished) {
  const std::vector<NumberBesideOurs> numbers = beside_ours(example());
  ASSERT_EQ(numbers.size(), 3u);
  EXPECT_EQ(numbers[0].what, "fog: rmse of slow over that of fast");
  EXPECT_NEAR(numbers[0].ours->value, 2, 0.02);
  EXPECT_GT(numbers[0].ours->error, 0);
  EXPECT_NEAR(*numbers[0].compared(), 0.5, 0.005);
  EXPECT_NEAR(*numbers[1].compared(), 20 * std::log10(20) - 30, 0.1) << "decibels are subtracted";
  EXPECT_FALSE(numbers[2].ours);
  EXPECT_FALSE(numbers[2].compared());
}

TEST(Relations, SayHowMuchLessTimeThanTheBaseline) {
  ExperimentResult result = example();
  EXPECT_TRUE(against_baseline(result).empty());
  EXPECT_TRUE(report_of(result, {}).overview.empty());
  result.experiment.baseline = "slow";
  for (const char* name : {"slow", "fast", "as fast"}) result.experiment.methods.push_back({name, "volpath"});
  result.scenes[0].methods[1].score.is_lost_in_reference = true;
  result.scenes[0].methods[2].score.mean_ratio = {0.9, 0.01};
  const std::vector<AgainstBaseline> all = against_baseline(result);
  ASSERT_EQ(all.size(), 2u) << "the baseline is not held against itself";
  EXPECT_EQ(all[0].method, "fast");
  EXPECT_NEAR(all[0].factor->value, 4, 0.1) << "half the error in equal time";
  EXPECT_GT(all[0].factor->error, 0);
  const ReportTable table = report_of(result, {}).overview.at(0);
  EXPECT_EQ(table.columns, (std::vector<std::string>{"method", "fog"}));
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_NE(std::get<std::string>(table.rows[0][1]).find("(about: below the reference's error)"), std::string::npos);
  EXPECT_TRUE(std::get<std::string>(table.rows[1][1]).ends_with(" ×, mean 0.90"));
  Estimate& cost = result.scenes[0].methods[1].score.cost;
  const Estimate before = cost;
  for (const Estimate& lost : {Estimate{-0.001, 0.05}, Estimate{0.01, 0.05}}) {
    cost = lost;
    EXPECT_TRUE(std::get<std::string>(report_of(result, {}).overview.at(0).rows[0][1])
                    .starts_with("not known (below the reference's error)"));
  }
  cost = before;
  result.rule.equal = EqualBy::kSamples;
  EXPECT_NEAR(against_baseline(result)[0].factor->value, 2, 0.05) << "the error itself";
  EXPECT_EQ(to_json(result, {}).at("against_baseline").size(), 2u);
}

TEST(Relations, HoldPicturesOfOneSeedAgainstEachOther) {
  ExperimentResult result = example();
  result.experiment.pairs = {{"fast", "slow"}};
  std::vector<MethodResult>& methods = result.scenes[0].methods;
  for (size_t c = 0; c < 3; ++c) {
    std::ranges::fill(methods[0].image.channel(c), 0.5f);
    std::ranges::fill(methods[1].image.channel(c), 0.48f);
  }
  std::vector<PairDifference> all = differences_of(result);
  ASSERT_EQ(all.size(), 1u);
  EXPECT_NEAR(all[0].rmse, 0.02, 1e-6);
  EXPECT_NEAR(all[0].psnr, 40, 1e-3) << "the peak is 2, the reference's";
  EXPECT_NEAR(all[0].mean_ratio, 0.96, 1e-6);
  EXPECT_TRUE(all[0].equal_samples);
  methods[0].runs[0].back().samples = 7;
  EXPECT_FALSE(differences_of(result)[0].equal_samples);
  EXPECT_EQ(to_json(result, {}).at("pairs")[0].at("against"), "slow");
  EXPECT_EQ(std::get<std::string>(report_of(result, {}).overview.at(0).rows[0][6]),
            "not of the same samples: one ran out of time");
}

TEST(Results, AsCommaSeparatedValues) {
  const std::string text = to_csv(example());
  EXPECT_TRUE(
      text.starts_with("scene,method,seed,seconds,wall_seconds,samples,rmse,rel_mse,mean_ratio\n"
                       "\"fog\",\"slow\",1,5.0000,2.5000,4,0.28"))
      << text;
  EXPECT_EQ(std::ranges::count(text, '\n'), 1 + 3 * 2 * 2);
}

TEST(Verdicts, SayWhichMethodIsBestAndByHowMuch) {
  const ReportVerdict verdict = verdict_of(example().scenes[0], EqualBy::kTime);
  EXPECT_EQ(verdict.place, "fog");
  EXPECT_EQ(verdict.winner, "fast");
  EXPECT_EQ(verdict.text,
            "least squared error × time. Not surely worse: 1.0 × as fast. Time that the others need for the same "
            "error: 4.0 × slow.");
}

TEST(Verdicts, SayWhenRelativeErrorSeesAnotherAhead) {
  ExperimentResult result = example();
  SceneResult& scene = result.scenes[0];
  EXPECT_EQ(verdict_of(scene, EqualBy::kTime).text.find("relMSE"), std::string::npos);
  scene.methods[0].score.rel_mse = {0.05, 0.001};
  EXPECT_NE(verdict_of(scene, EqualBy::kTime).text.find("do not rule, slow is ahead."), std::string::npos);
  scene.methods[0].score.rel_mse = {0.09, 0.02};
  EXPECT_EQ(verdict_of(scene, EqualBy::kTime).text.find("relMSE"), std::string::npos) << "not sure";
}

TEST(Verdicts, SayWhenTheReferenceIsTooNoisy) {
  ExperimentResult result = example();
  MethodScore& best = result.scenes[0].methods[1].score;
  best.is_lost_in_reference = true;
  EXPECT_EQ(verdict_of(result.scenes[0], EqualBy::kTime).winner, "fast") << "what is left is known well enough";
  best.cost = {0.02, 0.05};
  const ReportVerdict verdict = verdict_of(result.scenes[0], EqualBy::kTime);
  EXPECT_EQ(verdict.winner, "undecided");
  EXPECT_TRUE(verdict.text.starts_with("the reference's own squared error")) << verdict.text;
}

TEST(Verdicts, WarnOfBiasAndOfFewSamples) {
  ExperimentResult result = example();
  MethodScore &slow = result.scenes[0].methods[0].score, &fast = result.scenes[0].methods[1].score;
  slow.mean_ratio = {0.77, 0.03};
  fast.mean_ratio = {0.9, 0.05};  // not sure
  slow.samples = {1, 0};
  EXPECT_TRUE(verdict_of(result.scenes[0], EqualBy::kTime)
                  .text.ends_with("Not as bright as the reference, which is 1: slow (0.77). Fewer samples per pixel "
                                  "than 4: slow (1)."))
      << verdict_of(result.scenes[0], EqualBy::kTime).text;
}

TEST(Glossary, SaysWhatMethodsAre) {
  ExperimentResult result = example();
  result.experiment.methods = {{"plain", "volpath,multiple_scattering=path,min_scattering=3"},
                               {"by table", "volpath,multiple_scattering=table,min_scattering=3"}};
  const std::vector<ReportTerm> terms = report_of(result, {}).glossary;
  ASSERT_EQ(terms.size(), 3u + 6u);
  EXPECT_TRUE(terms[0].text.starts_with("volpath: path tracing with media: ")) << terms[0].text;
  EXPECT_TRUE(terms[0].text.ends_with(". multiple_scattering = path: by this method.")) << terms[0].text;
  EXPECT_TRUE(terms[1].text.ends_with(". multiple_scattering = table: looked up, as if the medium had no end."))
      << terms[1].text;
  EXPECT_EQ(terms[2].name, "all of them");
  EXPECT_EQ(terms[2].text, "min_scattering = 3: least collisions in media of a path that counts.");
  EXPECT_EQ(to_json(report_of(result, {}))["glossary"][1]["name"], "by table");
}

TEST(Verdicts, StandInTheReport) {
  const Report report = report_of(example(), {{"command", "c"}});
  EXPECT_EQ(report.verdicts.size(), 1u);
  ASSERT_EQ(report.groups.size(), 1u);
  EXPECT_EQ(report.groups[0].images.front().name, "fast");
  EXPECT_TRUE(report.groups[0].images.back().is_reference);
  ASSERT_EQ(report.plots.size(), 1u);
  EXPECT_EQ(report.plots[0].series.size(), 3u);
  EXPECT_EQ(report.plots[0].series[0].low.size(), 2u);
  const nlohmann::ordered_json json = to_json(report);
  EXPECT_EQ(json["verdicts"][0]["winner"], "fast");
  EXPECT_GT(json["groups"][0]["images"][0]["metrics"]["cost_error"].get<double>(), 0);
}

TEST(WithError, ShowsWhatIsKnown) {
  EXPECT_EQ(with_error({0.123456, 0.0042}), "0.1235 ± 0.0042");
  EXPECT_EQ(with_error({12.3456, 0.5}), "12.35 ± 0.50");
  EXPECT_EQ(with_error({1234.5, 120}), "1234 ± 120");
  EXPECT_EQ(with_error({1.23e-7, 4e-9}), "1.230e-07 ± 4.0e-09");
  EXPECT_EQ(with_error({2, 0}), "2");
  EXPECT_EQ(with_error({NAN, 1}), "–");
}

TEST(MarkdownTables, AreFoundInWhatProgramsPrint) {
  const std::vector<ReportTable> tables = markdown_tables(
      "\n# First: 1 + 1\n| a | b |\n| --- | --- |\n| x | 1.5 |\n| y | 2 s |\n\nplain text\n| no table |\n\nSecond\n\n"
      "| c |\n| --- |\n| 3 |\n");
  ASSERT_EQ(tables.size(), 2u);
  EXPECT_EQ(tables[0].title, "First: 1 + 1");
  EXPECT_EQ(tables[0].columns, (std::vector<std::string>{"a", "b"}));
  ASSERT_EQ(tables[0].rows.size(), 2u);
  EXPECT_EQ(std::get<double>(tables[0].rows[0][1]), 1.5);
  EXPECT_EQ(std::get<std::string>(tables[0].rows[1][1]), "2 s");
  EXPECT_EQ(tables[1].title, "Second");
  EXPECT_EQ(std::get<double>(tables[1].rows[0][0]), 3);
}

}  // namespace
}  // namespace turbid
