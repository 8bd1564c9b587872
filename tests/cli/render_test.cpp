// The program as people use it: the files it leaves, interruption, resuming, sudden death.
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <thread>

#include "child_process.h"
#include "core/rng.h"
#include "image/atomic_file.h"
#include "image/image_file.h"
#include "render/checkpoint.h"
#include "small_scene.h"
#include "testing/peer_scenes.h"
#include "testing/temporary_folder.h"

namespace turbid {
namespace {

namespace fs = std::filesystem;
using testing::ChildProcess;
using testing::Outcome;
using testing::run_turbid;
using testing::TemporaryFolder;

bool same_pixels(const Image& a, const Image& b) {
  if (a.channel_names() != b.channel_names() || a.pixel_count() != b.pixel_count()) return false;
  for (size_t c = 0; c < a.channel_count(); ++c)
    if (!std::equal(a.channel(c).begin(), a.channel(c).end(), b.channel(c).begin())) return false;
  return true;
}

void sleep_for(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

class Program : public ::testing::Test {
 protected:
  Program() { testing::write_small_scene(file("small.xml")); }

  std::string file(const std::string& name) const { return folder_.file(name); }
  std::string folder() const { return folder_.path().string(); }
  Outcome run(const std::vector<std::string>& arguments) const {
    const Outcome outcome = run_turbid(folder(), arguments);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
    return outcome;
  }
  /// Waits until a file is there.
  bool appears(const std::string& name, ChildProcess& process) const {
    for (int i = 0; i < 3000 && !process.has_ended(); ++i) {
      if (fs::exists(file(name))) return true;
      sleep_for(0.01);
    }
    return fs::exists(file(name));
  }
  bool has_parts() const {
    for (const auto& entry : fs::directory_iterator(folder_.path()))
      if (entry.path().extension() == ".part") return true;
    return false;
  }

  TemporaryFolder folder_;
};

TEST_F(Program, WritesImagePictureVarianceAndStatistics) {
  run({"render", "small.xml", "--spp", "20", "--variance", "--json", "stats.json", "--seed", "7"});
  const Image image = read_image(file("small.exr"));
  EXPECT_EQ(image.width(), 48);
  EXPECT_TRUE(image.has_all({"R", "G", "B", "inner.X", "m2_inner.Z"}));
  EXPECT_EQ(image.metadata.at("scene"), "small.xml");
  EXPECT_EQ(image.metadata.at("command"), "turbid render small.xml --spp 20 --variance --json stats.json --seed 7");
  EXPECT_EQ(image.metadata.at("samples"), "20");
  EXPECT_EQ(image.metadata.at("seed"), "7");
  EXPECT_EQ(image.metadata.at("integrator"), "moment(volpath max_depth=6)");
  EXPECT_TRUE(fs::exists(file("small.png")));
  EXPECT_EQ(read_image(file("small_var.exr")).width(), 48);
  EXPECT_FALSE(fs::exists(file("small.ckpt")));
  const auto stats = nlohmann::json::parse(read_file(file("stats.json")));
  EXPECT_EQ(stats["samples_per_pixel"], 20);
  EXPECT_EQ(stats["samples"], 20 * 48 * 48);
  EXPECT_EQ(stats["dropped_samples"], 0);
  for (const char* key : {"wall_seconds", "cpu_seconds", "passes", "rays", "peak_memory_bytes"})
    EXPECT_GT(stats[key].get<double>(), 0) << key;
}

TEST_F(Program, OverridesSizeIntegratorAndSceneSampleCount) {
  const Outcome outcome =
      run({"render", "small.xml", "-D", "res=40", "--integrator", "path,max_depth=3", "-o", "out.exr"});
  const Image image = read_image(file("out.exr"));
  EXPECT_EQ(image.width(), 40);
  EXPECT_EQ(image.metadata.at("samples"), "16");
  EXPECT_EQ(image.metadata.at("integrator"), "moment(path max_depth=3)");
  EXPECT_NE(outcome.errors.find("wrote out.exr, out.png"), std::string::npos) << outcome.errors;
  EXPECT_EQ(run({"render", "small.xml", "--size", "33x20", "--passes", "1", "--quiet"}).errors, "");
  EXPECT_EQ(read_image(file("small.exr")).height(), 20);
  EXPECT_EQ(read_image(file("small.exr")).metadata.at("samples"), "64");
}

TEST_F(Program, SameBitsWithOneTwoAndSevenThreads) {
  for (const std::string n : {"1", "2", "7"})
    run({"render", "small.xml", "--spp", "70", "--threads", n, "-o", n + ".exr"});
  const Image one = read_image(file("1.exr"));
  EXPECT_TRUE(same_pixels(one, read_image(file("2.exr"))));
  EXPECT_TRUE(same_pixels(one, read_image(file("7.exr"))));
  run({"render", "small.xml", "--spp", "70", "--seed", "1", "-o", "other.exr"});
  EXPECT_FALSE(same_pixels(one, read_image(file("other.exr"))));
}

TEST_F(Program, TheTimeBudgetIsKept) {
  run({"render", "small.xml", "--time", "0.7", "--json", "stats.json"});
  const auto stats = nlohmann::json::parse(read_file(file("stats.json")));
  EXPECT_GE(stats["wall_seconds"].get<double>(), 0.7);
  EXPECT_LT(stats["wall_seconds"].get<double>(), 5);
  EXPECT_GE(stats["passes"], 1);
}

TEST_F(Program, AnInterruptedRenderResumesToTheSameBits) {
  ChildProcess process(folder(), {"render", "small.xml", "--time", "1000", "--save-every", "0"});
  ASSERT_TRUE(appears("small.ckpt", process));
  const auto start = std::chrono::steady_clock::now();
  process.send(SIGTERM);
  const Outcome outcome = process.wait();
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(3));  // 0.1 s on a machine that is idle
  EXPECT_EQ(outcome.exit_code, 130) << outcome.errors;
  EXPECT_NE(outcome.errors.find("small.ckpt was left; the same command with --resume goes on"), std::string::npos);
  const uint64_t samples = read_checkpoint(file("small.ckpt")).film.samples();
  EXPECT_EQ(read_image(file("small.exr")).metadata.at("samples"), std::to_string(samples));
  const std::string end = std::to_string(samples + 100);
  run({"render", "small.xml", "--spp", end, "--resume", "--threads", "1"});
  run({"render", "small.xml", "--spp", end, "-o", "whole.exr"});
  EXPECT_TRUE(same_pixels(read_image(file("small.exr")), read_image(file("whole.exr"))));
}

TEST_F(Program, ACheckpointOfAnotherRenderIsRefused) {
  run({"render", "small.xml", "--spp", "64", "--resume"});
  ASSERT_TRUE(fs::exists(file("small.ckpt")));
  for (const std::vector<std::string>& change : std::vector<std::vector<std::string>>{
           {"--seed", "1"}, {"-D", "res=50"}, {"--integrator", "path"}, {"--size", "48x48"}}) {
    std::vector<std::string> words{"render", "small.xml", "--spp", "128", "--resume"};
    words.insert(words.end(), change.begin(), change.end());
    const Outcome outcome = run_turbid(folder(), words);
    EXPECT_EQ(outcome.exit_code, 4) << change.front();
    EXPECT_NE(outcome.errors.find("is the checkpoint of another render"), std::string::npos) << outcome.errors;
  }
  run({"render", "small.xml", "--spp", "128", "--resume", "--threads", "1", "--save-every", "5"});
  std::ofstream(file("small.xml"), std::ios::app) << "<!-- changed -->";
  EXPECT_EQ(run_turbid(folder(), {"render", "small.xml", "--spp", "128", "--resume"}).exit_code, 4);
}

TEST_F(Program, HangupHasTheImageWrittenAndASecondInterruptEndsAtOnce) {
  ChildProcess process(folder(), {"render", "small.xml", "--time", "1000"});
  sleep_for(0.3);
  process.send(SIGHUP);
  ASSERT_TRUE(appears("small.exr", process));
  EXPECT_FALSE(process.has_ended());
  process.send(SIGINT);
  EXPECT_EQ(process.wait().exit_code, 130);
}

TEST_F(Program, KilledAtAnyMomentItsFilesAreWhole) {
  Rng rng(9);
  uint64_t before = 0;
  int with_checkpoint = 0;
  for (int i = 0; i < 20; ++i) {
    ChildProcess process(folder(),
                         {"render", "small.xml", "--time", "1000", "--save-every", "0", "--resume", "--variance"});
    if (i > 0 || appears("small.ckpt", process)) sleep_for(0.05 + 0.15 * rng.next_double());
    process.send(SIGKILL);
    ASSERT_EQ(process.wait().signal, SIGKILL);
    if (!fs::exists(file("small.ckpt"))) continue;
    ++with_checkpoint;
    const uint64_t samples = read_checkpoint(file("small.ckpt")).film.samples();  // throws when it is damaged
    EXPECT_GE(samples, before);
    before = samples;
    for (const char* name : {"small.exr", "small.png", "small_var.exr"}) EXPECT_EQ(read_image(file(name)).width(), 48);
  }
  EXPECT_GT(with_checkpoint, 10);
  // What is left is good enough to go on from.
  const std::string end = std::to_string(before + 10);
  run({"render", "small.xml", "--spp", end, "--resume"});
  run({"render", "small.xml", "--spp", end, "-o", "whole.exr"});
  EXPECT_TRUE(same_pixels(read_image(file("small.exr")), read_image(file("whole.exr"))));
  EXPECT_FALSE(has_parts());
}

TEST_F(Program, ComparesImages) {
  run({"render", "small.xml", "--spp", "256", "--variance", "-o", "ref.exr"});
  run({"render", "small.xml", "--spp", "64", "--seed", "5", "-o", "a.exr"});
  const auto json = nlohmann::json::parse(run({"compare", "a.exr", "ref.exr", "--json"}).output);
  EXPECT_GT(json["rmse"].get<double>(), 0);
  EXPECT_NEAR(json["mean_ratio"].get<double>(), 1, 0.05);
  EXPECT_FALSE(json.contains("z_test"));
  // A *_var.exr and the layers of a moment integrator say the same.
  for (const char* variance : {"ref_var.exr", "ref.exr"}) {
    const Outcome outcome = run({"compare", "a.exr", "ref.exr", "--variance", variance, "--spp", "16"});
    EXPECT_NE(outcome.output.find("accepted"), std::string::npos) << outcome.output;
  }
  run({"render", "small.xml", "--spp", "64", "--seed", "5", "--integrator", "volpath,max_scattering=1", "-o", "b.exr"});
  EXPECT_NE(run({"compare", "b.exr", "ref.exr", "--variance", "ref_var.exr"}).output.find("REJECTED"),
            std::string::npos);
  run({"render", "small.xml", "--spp", "1", "--size", "20x20", "-o", "c.exr"});
  const Outcome outcome = run_turbid(folder(), {"compare", "c.exr", "ref.exr"});
  EXPECT_EQ(outcome.exit_code, 4);
  EXPECT_NE(outcome.errors.find("c.exr: is 20 x 20 pixels, ref.exr is 48 x 48"), std::string::npos);
}

TEST_F(Program, ReadsTheReferencesAndVariancesOfMitsubasRenderTests) {
  const fs::path refs = testing::peer_scenes() / "tests/scenes/participating_media/refs";
  if (!fs::exists(refs)) GTEST_SKIP() << testing::peer_scenes_absent();
  const std::string reference = fs::absolute(refs / "test_homo_area_light_ref_rgb.exr").string();
  const std::string variance = fs::absolute(refs / "test_homo_area_light_ref_rgb_var.exr").string();
  EXPECT_NE(run({"compare", reference, reference, "--variance", variance, "--spp", "100"}).output.find("accepted"),
            std::string::npos);
  Image brighter = read_image(reference);
  for (size_t c = 0; c < brighter.channel_count(); ++c)
    for (float& v : brighter.channel(c)) v *= 1.05f;
  write_exr(file("brighter.exr"), brighter);
  EXPECT_NE(
      run({"compare", "brighter.exr", reference, "--variance", variance, "--spp", "1000000"}).output.find("REJECTED"),
      std::string::npos);
}

TEST_F(Program, TheDefaultSceneRenders) {
  run({"render", "--spp", "1", "--size", "32x24"});
  EXPECT_TRUE(fs::exists(file("turbid.exr")));
  EXPECT_TRUE(fs::exists(file("turbid.png")));
}

}  // namespace
}  // namespace turbid
