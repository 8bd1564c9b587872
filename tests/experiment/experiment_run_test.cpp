// Experiments from end to end, tiny ones: what is kept, reused, resumed and written.
#include "experiment/experiment_run.h"

#include <gtest/gtest.h>
#include <signal.h>

#include <filesystem>
#include <thread>

#include "core/error.h"
#include "core/log.h"
#include "experiment/contest.h"
#include "experiment/results.h"
#include "experiment/results_page.h"
#include "experiment/summary.h"
#include "image/atomic_file.h"
#include "image/image_file.h"
#include "small_experiment.h"

namespace turbid {
namespace {

namespace fs = std::filesystem;
using testing::ExperimentFolder;
using testing::small_experiment;

class ExperimentRun : public ::testing::Test {
 protected:
  ExperimentRun() { set_log_level(LogLevel::kQuiet); }

  ExperimentOptions options() {
    ExperimentOptions result;
    result.folder = folder_.file("out");
    result.cache = folder_.file("cache");
    result.tell = [this](const std::string& text) { told_ += text + "\n"; };
    return result;
  }
  ExperimentResult run() {
    told_.clear();
    return run_experiment(folder_.read(), options());
  }
  size_t told(const std::string& what) const {
    size_t count = 0;
    for (size_t at = 0; (at = told_.find(what, at)) != std::string::npos; ++at) ++count;
    return count;
  }

  ExperimentFolder folder_;
  std::string told_;
};

TEST_F(ExperimentRun, MeasuresAllMethods) {
  const ExperimentResult result = run();
  ASSERT_EQ(result.scenes.size(), 1u);
  const SceneResult& scene = result.scenes[0];
  EXPECT_GT(scene.reference.samples, 64u);
  EXPECT_TRUE(scene.reference.version.starts_with("turbid ")) << scene.reference.version;
  ASSERT_EQ(scene.methods.size(), 2u);
  for (const MethodResult& made : scene.methods) {
    ASSERT_EQ(made.runs.size(), 3u);
    for (const Curve& curve : made.runs) {
      ASSERT_EQ(curve.size(), 3u);
      EXPECT_EQ(curve[0].samples, 2u);
      EXPECT_EQ(curve[1].samples, 4u);
      EXPECT_EQ(curve[2].samples, 8u);
      EXPECT_GT(curve[2].seconds, curve[0].seconds);
    }
    // The same picture with different seeds: as bright as the reference, different noise.
    EXPECT_NEAR(made.score.mean_ratio.value, 1, 0.05 + 4 * made.score.mean_ratio.error);
    EXPECT_NE(made.runs[0][2].error.mse, made.runs[1][2].error.mse);
    EXPECT_GT(made.score.rmse.value, 0);
    EXPECT_EQ(made.image.width(), 12);
  }
  EXPECT_EQ(ranked(scene, EqualBy::kSamples).front()->method.name, "paths");
}

/// Links in the gallery lead to pictures.
TEST_F(ExperimentRun, MakesAGallery) {
  const ExperimentResult result = run();
  const std::string folder = folder_.file("gallery"), name = result.experiment.name;
  fs::create_directories(folder + "/" + name);
  fs::create_directories(folder + "/other");
  write_file_atomically(folder + "/" + name + "/summary.md", write_summary(result, folder));
  Experiment figure;
  figure.name = "other";
  figure.title = "A figure";
  write_file_atomically(folder + "/other/summary.md", summary_of(figure, "| a |\n"));
  const std::string text = read_file(write_gallery(folder));
  EXPECT_NE(text.find("## A figure"), std::string::npos) << text;
  EXPECT_NE(text.find("**fog**: paths: "), std::string::npos) << text;
  size_t pictures = 0;
  for (size_t at = 0; (at = text.find("](", at)) != std::string::npos; ++pictures) {
    const size_t end = text.find(')', at += 2);
    EXPECT_EQ(read_image(folder + "/" + text.substr(at, end - at)).width(), 12) << text.substr(at, end - at);
  }
  EXPECT_EQ(pictures, 3u) << "reference and two methods\n" << text;
}

TEST_F(ExperimentRun, FindsAgainWhatIsFinished) {
  const ExperimentResult first = run();
  EXPECT_EQ(told("seed "), 6u);
  EXPECT_EQ(told("reference rendered"), 1u);
  const ExperimentResult second = run();
  EXPECT_EQ(told("seed "), 0u) << told_;
  EXPECT_EQ(told("reference from the cache"), 1u) << told_;
  for (size_t m = 0; m < 2; ++m) {
    const MethodResult &a = first.scenes[0].methods[m], &b = second.scenes[0].methods[m];
    EXPECT_EQ(a.score.rmse.value, b.score.rmse.value);
    EXPECT_EQ(a.runs[2][2].seconds, b.runs[2][2].seconds);
    EXPECT_EQ(a.image.channel("R")[7], b.image.channel("R")[7]);
  }
}

TEST_F(ExperimentRun, MakesAgainWhatIsMissingDamagedOrOutOfDate) {
  run();
  fs::remove(folder_.file("out/runs/fog-paths-2.json"));
  write_file_atomically(folder_.file("out/runs/fog-light-tracing-1.json"), std::string_view("{\"format\": 1, \"cur"));
  run();
  EXPECT_EQ(told("seed "), 2u) << told_;
  // Another setting of one method: its runs alone.
  auto json = small_experiment();
  json["methods"][0]["integrator"] = "volpath,rr_depth=3";
  folder_.write(json);
  run();
  EXPECT_EQ(told("seed "), 3u) << told_;
  EXPECT_EQ(told("reference from the cache"), 1u);
  // Another scene: everything, the reference too.
  json["scenes"][0]["define"]["density"] = 1;
  folder_.write(json);
  run();
  EXPECT_EQ(told("seed "), 6u) << told_;
  EXPECT_EQ(told("reference rendered"), 1u);
}

TEST_F(ExperimentRun, AReferenceGoesOnWhereItWas) {
  const ExperimentResult short_one = run();
  auto json = small_experiment();
  json["reference"]["seconds"] = 0.6;
  folder_.write(json);
  const ExperimentResult longer = run();
  EXPECT_EQ(told("reference rendered"), 1u);
  EXPECT_EQ(told("seed "), 6u) << "errors against another reference are other errors\n" << told_;
  const Reference &a = short_one.scenes[0].reference, &b = longer.scenes[0].reference;
  EXPECT_EQ(a.key, b.key);
  EXPECT_GT(b.samples, a.samples);
  EXPECT_GE(b.wall, a.wall);
  EXPECT_LT(b.error.mse.value, a.error.mse.value);
  // A damaged half is rendered again.
  for (const auto& entry : fs::directory_iterator(folder_.file("cache")))
    if (entry.path().string().ends_with("-2.ckpt"))
      write_file_atomically(entry.path().string(), std::string_view("turbid ckpt\nnonsense"));
  run();
  EXPECT_EQ(told("reference rendered"), 1u);
}

TEST_F(ExperimentRun, AnInterruptionKeepsWhatIsFinished) {
  // Ctrl-C in the second run.
  int runs = 0;
  ExperimentOptions with = options();
  std::jthread later;
  with.tell = [&](const std::string& text) {
    if (text.find("seed ") != std::string::npos && ++runs == 1)
      later = std::jthread([] {
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        ::raise(SIGINT);
      });
  };
  auto json = small_experiment();
  json["compare"] = {{"by", "equal time"}, {"seconds", 0.4}};
  folder_.write(json);
  EXPECT_THROW(run_experiment(folder_.read(), with), Interrupted);
  later.join();
  const ExperimentResult result = run();
  EXPECT_EQ(told("seed "), 6u - static_cast<size_t>(runs)) << told_;
  EXPECT_EQ(result.scenes[0].methods[0].runs.size(), 3u);
}

TEST_F(ExperimentRun, EqualTimeEndsWithTheTime) {
  auto json = small_experiment();
  json["compare"] = {{"by", "equal time"}, {"seconds", 0.2}};
  json["points"] = 4;
  folder_.write(json);
  const ExperimentResult result = run();
  for (const MethodResult& made : result.scenes[0].methods)
    for (const Curve& curve : made.runs) {
      ASSERT_GE(curve.size(), 2u);
      EXPECT_GE(curve.back().seconds, 0.2);
      EXPECT_EQ(curve.back().level, 3);
      for (size_t i = 1; i < curve.size(); ++i) {
        EXPECT_GT(curve[i].samples, curve[i - 1].samples);
        EXPECT_GT(curve[i].level, curve[i - 1].level);
      }
    }
}

TEST_F(ExperimentRun, EqualErrorEndsWithTheError) {
  auto json = small_experiment();
  json["compare"] = {{"by", "equal error"}, {"error", 0.06}, {"seconds", 2.5}};
  json["points"] = 16;
  folder_.write(json);
  const ExperimentResult result = run();
  const SceneResult& scene = result.scenes[0];
  const MethodResult& paths = scene.method("paths");
  ASSERT_TRUE(paths.score.seconds_to_error);
  EXPECT_LT(paths.score.seconds_to_error->value, 2.5);
  EXPECT_LE(paths.score.relative.value, 0.065);
  // Where the error cannot be reached, there is no time.
  json["compare"] = {{"by", "equal error"}, {"error", 1e-5}, {"seconds", 0.1}};
  folder_.write(json);
  const ExperimentResult hopeless = run();
  EXPECT_FALSE(hopeless.scenes[0].methods[0].score.seconds_to_error);
  EXPECT_NE(verdict_of(hopeless.scenes[0], EqualBy::kError).text.find("no method"), std::string::npos);
}

TEST_F(ExperimentRun, ErrorsAreThoseOfTheImages) {
  const ExperimentResult result = run();
  const MethodResult& paths = result.scenes[0].methods[0];
  const Image image = read_exr(folder_.file("out/images/fog-paths.exr"));
  const Image reference = read_exr(folder_.file("out/images/fog-reference.exr"));
  const double rmse = compare_images(color_channels(image, "i"), color_channels(reference, "r")).rmse;
  EXPECT_NEAR(rmse * rmse, paths.runs[0].back().error.mse, 1e-5 * rmse * rmse);
}

TEST(FileNames, KeepLettersAndDigits) {
  EXPECT_EQ(file_name("S5, q = 0.3"), "s5-q-0.3");
  EXPECT_EQ(file_name("../../etc"), "..-..-etc");
  EXPECT_EQ(file_name("!"), "_");
}

}  // namespace
}  // namespace turbid
