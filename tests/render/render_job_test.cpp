#include "render/render_job.h"

#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include "core/error.h"
#include "core/log.h"
#include "image/atomic_file.h"
#include "image/image_file.h"
#include "render/checkpoint.h"
#include "render/threads.h"
#include "testing/temporary_folder.h"
#include "toy_task.h"

namespace turbid {
namespace {

namespace fs = std::filesystem;
using testing::same_bits;
using testing::TemporaryFolder;
using testing::ToyTask;

/// The toy's passes have 64 samples per pixel.
constexpr uint64_t kPerPass = 64;

class RenderJob : public ::testing::Test {
 protected:
  RenderJob() { set_log_level(LogLevel::kQuiet); }
  ~RenderJob() override { set_log_level(LogLevel::kNotices); }

  RenderOptions options(Budget budget) const {
    RenderOptions result;
    result.budget = budget;
    result.seed = 11;
    result.fingerprint = 42;
    result.quiet = true;
    result.output.path = folder_.file("a.exr");
    return result;
  }
  std::string checkpoint() const { return folder_.file("a.ckpt"); }
  size_t file_count() const {
    return static_cast<size_t>(std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator()));
  }

  /// Renders until a pass sends the signal, at 2 whole passes.
  RenderResult interrupted_render(Budget budget, int signal = SIGINT, bool resume = false) const {
    ToyTask toy;
    toy.on_pass = [signal](uint64_t index) {
      if (index != 2) return;
      ::raise(signal);
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    };
    RenderOptions with = options(budget);
    with.resume = resume;
    return render(toy.task(), with);
  }
  static Film uninterrupted(uint64_t samples) {
    RenderOptions plain;
    plain.budget.samples = samples;
    plain.seed = 11;
    plain.quiet = true;
    return render(ToyTask().task(), plain).film;
  }

  TemporaryFolder folder_;
};

TEST_F(RenderJob, EndsAtTheSamplesAskedForAndWritesItsFiles) {
  RenderOptions with = options({.samples = 100});
  with.output.variance = true;
  with.output.moment_name = "path";
  with.output.alpha = true;
  with.output.metadata = {{"scene", "toy"}};
  const RenderResult result = render(ToyTask().task(), with);
  EXPECT_EQ(result.film.samples(), 100u);
  EXPECT_FALSE(result.statistics.interrupted);
  EXPECT_EQ(result.statistics.passes, 2u);
  EXPECT_EQ(result.statistics.samples, 100u * 8000u);
  EXPECT_EQ(result.files,
            (std::vector<std::string>{folder_.file("a.exr"), folder_.file("a_var.exr"), folder_.file("a.png")}));
  EXPECT_EQ(file_count(), 3u);
  const Image image = read_image(folder_.file("a.exr"));
  EXPECT_EQ(image.metadata.at("samples"), "100");
  EXPECT_EQ(image.metadata.at("passes"), "2");
  EXPECT_EQ(image.metadata.at("scene"), "toy");
  EXPECT_TRUE(image.metadata.contains("seconds"));
  EXPECT_TRUE(image.has_all({"R", "G", "B", "A", "path.X", "m2_path.Z"}));
  EXPECT_EQ(image.channel("R")[9], static_cast<float>(result.film.pixel(9).radiance[0] / 100));
  EXPECT_GT(result.statistics.peak_memory, 1u << 20);
  const std::string json = to_json(result.statistics, {{"scene", "toy"}});
  for (const char* word : {"\"scene\": \"toy\"", "\"passes\": 2", "\"rays\": 7", "\"dropped_samples\": 1",
                           "cpu_seconds", "wall_seconds", "peak_memory_bytes", "\"samples\": 800000"})
    EXPECT_NE(json.find(word), std::string::npos) << word << " in " << json;
}

TEST_F(RenderJob, IsLookedAtAfterEachPassAndEndsWhenToldTo) {
  RenderOptions with = options({});
  with.growing_passes = true;
  std::vector<uint64_t> seen;
  with.after_pass = [&](const Film& film) {
    seen.push_back(film.samples());
    return film.samples() < 3;
  };
  const RenderResult result = render(ToyTask().task(), with);
  EXPECT_EQ(seen, (std::vector<uint64_t>{1, 2, 3}));
  EXPECT_EQ(result.film.samples(), 3u);
  EXPECT_FALSE(result.statistics.interrupted);
  EXPECT_FALSE(read_image(folder_.file("a.exr")).metadata.contains("passes"));
  const Film whole = uninterrupted(3);
  EXPECT_NEAR(result.film.pixel(9).radiance[0], whole.pixel(9).radiance[0], 1e-9 * whole.pixel(9).radiance[0]);
}

TEST_F(RenderJob, SameBitsWithAnyNumberOfThreads) {
  const auto film_with = [](int threads) { return with_threads(threads, [] { return uninterrupted(200); }); };
  const Film one = film_with(1);
  EXPECT_TRUE(same_bits(one, film_with(2)));
  EXPECT_TRUE(same_bits(one, film_with(7)));
  RenderOptions other;
  other.budget.samples = 200;
  other.seed = 12;
  other.quiet = true;
  EXPECT_FALSE(same_bits(one, render(ToyTask().task(), other).film));
}

TEST_F(RenderJob, InterruptionWritesImageAndCheckpointAndResumesToTheSameBits) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const RenderResult first = interrupted_render({.samples = 300}, signal);
    EXPECT_TRUE(first.statistics.interrupted);
    EXPECT_EQ(first.film.samples(), 2 * kPerPass);
    EXPECT_EQ(first.checkpoint, checkpoint());
    EXPECT_TRUE(same_bits(read_checkpoint(checkpoint()).film, first.film));
    EXPECT_EQ(read_image(folder_.file("a.exr")).metadata.at("samples"), "128");
    EXPECT_EQ(file_count(), 3u);

    RenderOptions with = options({.samples = 300});
    with.resume = true;
    const RenderResult second = render(ToyTask().task(), with);
    EXPECT_FALSE(second.statistics.interrupted);
    EXPECT_EQ(second.statistics.passes, 3u);  // 2 of 5 were there
    EXPECT_GT(second.seconds, second.statistics.wall_seconds);
    EXPECT_TRUE(same_bits(second.film, uninterrupted(300)));
    EXPECT_TRUE(fs::exists(checkpoint()));
    fs::remove(checkpoint());
  }
}

TEST_F(RenderJob, InterruptedTwiceAndWithOtherBudgetsStillTheSameBits) {
  interrupted_render({.seconds = 1000}, SIGTERM);
  const RenderResult second = interrupted_render({.samples = 1000}, SIGINT, true);
  EXPECT_TRUE(second.statistics.interrupted);
  EXPECT_EQ(second.film.samples(), 4 * kPerPass);
  RenderOptions with = options({.passes = 9});
  with.resume = true;
  EXPECT_TRUE(same_bits(render(ToyTask().task(), with).film, uninterrupted(9 * kPerPass)));
}

TEST_F(RenderJob, AShortLastPassIsMadeAgainWhole) {
  RenderOptions with = options({.samples = 72});
  with.resume = true;
  EXPECT_TRUE(same_bits(render(ToyTask().task(), with).film, uninterrupted(72)));
  EXPECT_EQ(read_checkpoint(checkpoint()).film.samples(), kPerPass);
  with.budget.samples = 8;  // fewer than are there: all of them stay
  EXPECT_EQ(render(ToyTask().task(), with).film.samples(), kPerPass);
  with.budget.samples = 200;
  EXPECT_TRUE(same_bits(render(ToyTask().task(), with).film, uninterrupted(200)));
}

TEST_F(RenderJob, TheComparisonWouldNoticeAnotherGrouping) {
  // Sums made in other groups differ in the last bits: this is what the plan of passes avoids.
  Film grouped({100, 80}, testing::kLayers), part({100, 80}, testing::kLayers);
  for (uint64_t first = 0; first < 200; first += 8) {
    part.clear();
    ToyTask().render_pass({11, first, 8}, part, StopFlag());
    grouped.add(part);
  }
  EXPECT_FALSE(same_bits(grouped, uninterrupted(200)));
}

TEST_F(RenderJob, ACompletedRenderRemovesItsCheckpoint) {
  interrupted_render({.samples = 300});
  EXPECT_TRUE(fs::exists(checkpoint()));
  render(ToyTask().task(), options({.samples = 64}));
  EXPECT_FALSE(fs::exists(checkpoint()));
}

TEST_F(RenderJob, ForeignAndDamagedCheckpointsAreNeverUsed) {
  interrupted_render({.samples = 300});
  RenderOptions with = options({.samples = 300});
  with.resume = true;
  with.fingerprint = 43;
  const auto error = [&] {
    try {
      render(ToyTask().task(), with);
    } catch (const Error& e) {
      EXPECT_EQ(e.exit_code(), 4);
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_EQ(error(), checkpoint() +
                         ": is the checkpoint of another render (its scene, integrator, size, seed or version differ)"
                         "; delete it or render without --resume to start from the beginning");
  std::string bytes = read_file(checkpoint());
  bytes[1000] ^= 1;
  write_file_atomically(checkpoint(), bytes);
  EXPECT_EQ(error(), checkpoint() +
                         ": is a damaged checkpoint (its checksum does not fit)"
                         "; delete it or render without --resume to start from the beginning");
  EXPECT_EQ(read_file(checkpoint()), bytes);  // left as it was
}

TEST_F(RenderJob, DoesNotOverwriteAForeignFileOfTheCheckpointsName) {
  std::ofstream(checkpoint()) << "weights of a neural network";
  EXPECT_THROW(render(ToyTask().task(), options({.samples = 64})), FileError);
  EXPECT_EQ(read_file(checkpoint()), "weights of a neural network");
}

TEST_F(RenderJob, ResumeWithoutACheckpointStartsFromTheBeginning) {
  RenderOptions with = options({.samples = 100});
  with.resume = true;
  EXPECT_TRUE(same_bits(render(ToyTask().task(), with).film, uninterrupted(100)));
}

TEST_F(RenderJob, TimeBudgetStopsNearItsEndButMakesOnePass) {
  ToyTask slow;
  slow.on_pass = [](uint64_t) { std::this_thread::sleep_for(std::chrono::milliseconds(30)); };
  const RenderResult result = render(slow.task(), options({.seconds = 0.3}));
  EXPECT_FALSE(result.statistics.interrupted);
  EXPECT_GE(result.statistics.passes, 1u);
  EXPECT_LT(result.statistics.wall_seconds, 1.5);
  EXPECT_EQ(result.film.samples(), result.statistics.passes * kPerPass);
  EXPECT_EQ(render(slow.task(), options({.seconds = 1e-9})).statistics.passes, 1u);
}

TEST_F(RenderJob, InterruptedBeforeTheFirstPassLeavesNothing) {
  ToyTask toy;
  toy.on_pass = [](uint64_t) {
    ::raise(SIGINT);
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  };
  const RenderResult result = render(toy.task(), options({.samples = 300}));
  EXPECT_TRUE(result.statistics.interrupted);
  EXPECT_TRUE(result.files.empty());
  EXPECT_EQ(file_count(), 0u);
}

TEST_F(RenderJob, HangupWritesTheImageAndGoesOn) {
  ToyTask toy;
  bool seen = false;
  toy.on_pass = [&](uint64_t index) {
    if (index == 1) ::raise(SIGHUP);
    if (index != 2) return;
    for (int i = 0; i < 400 && !seen; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      seen = fs::exists(folder_.file("a.exr")) && fs::exists(folder_.file("a.png"));
    }
  };
  const RenderResult result = render(toy.task(), options({.samples = 256}));
  EXPECT_TRUE(seen);
  EXPECT_FALSE(result.statistics.interrupted);
  EXPECT_TRUE(same_bits(result.film, uninterrupted(256)));
}

TEST_F(RenderJob, SavesMeanwhile) {
  ToyTask toy;
  uint64_t samples = 0;
  toy.on_pass = [&](uint64_t index) {
    if (index != 3) return;
    for (int i = 0; i < 400 && samples == 0; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      if (fs::exists(checkpoint())) samples = read_checkpoint(checkpoint()).film.samples();
    }
  };
  RenderOptions with = options({.passes = 5});
  with.save_seconds = 0;
  const RenderResult result = render(toy.task(), with);
  EXPECT_GE(samples, kPerPass);
  EXPECT_LE(samples, 3 * kPerPass);
  EXPECT_TRUE(same_bits(result.film, uninterrupted(5 * kPerPass)));
  EXPECT_FALSE(fs::exists(checkpoint()));
}

TEST_F(RenderJob, AnUnwritableImageIsAnErrorBeforeTheFirstPass) {
  ToyTask toy;
  RenderOptions with = options({.samples = 64});
  with.output.path = folder_.file("no/folder/a.exr");
  EXPECT_THROW(render(toy.task(), with), FileError);
  EXPECT_EQ(*toy.begun, 0u);
}

TEST_F(RenderJob, AnErrorInAPassComesOut) {
  ToyTask toy;
  toy.on_pass = [](uint64_t) { throw std::runtime_error("broken"); };
  EXPECT_THROW(render(toy.task(), options({.samples = 64})), std::runtime_error);
}

}  // namespace
}  // namespace turbid
