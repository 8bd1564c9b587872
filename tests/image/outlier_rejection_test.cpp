#include "image/outlier_rejection.h"

#include <gtest/gtest.h>

#include <functional>
#include <numeric>

#include "core/rng.h"
#include "image/film_image.h"

namespace turbid {
namespace {

constexpr int kSide = 32;
const OutlierSettings kPaper;

/// The sample of a pixel with a number.
using Source = std::function<Spectrum(size_t pixel, uint64_t sample)>;

Film expose(const Source& source, uint64_t samples, const Vec2i& size = {kSide, kSide},
            const OutlierSettings& settings = kPaper) {
  Film film(size, Cascades::layer_names());
  const Cascades cascades(settings);
  for (size_t pixel = 0; pixel < film.pixel_count(); ++pixel)
    for (uint64_t i = 0; i < samples; ++i) {
      const Spectrum sample = source(pixel, i);
      film.pixel(pixel).add({sample});
      cascades.add(film.layers(pixel), sample);
    }
  film.add_samples(samples);
  return film;
}

Image develop(const Film& film, const OutlierSettings& settings = kPaper) {
  return reject_outliers(film_to_image(film, false), film, settings);
}

double mean(std::span<const float> channel) {
  return std::accumulate(channel.begin(), channel.end(), 0.0) / static_cast<double>(channel.size());
}

bool keeps_the_mean(const Image& image) {
  for (size_t c = 0; c < kChannels; ++c)
    if (!std::ranges::equal(image.channel(c), image.channel(kUnweightedNames[c]))) return false;
  return true;
}

float random(size_t pixel, uint64_t sample) { return Rng(hash_counters(7, pixel, sample)).next_float(); }

/// Smooth: a coloured ramp, each sample within a factor of 2 around it.
Spectrum ramp(size_t pixel, uint64_t sample) {
  const float brightness = 0.02f * std::exp2(static_cast<float>(pixel % kSide) / 3);  // to 26
  return Spectrum(1, 0.5f, 0.2f) * (brightness * (0.67f + 0.67f * random(pixel, sample)));
}

TEST(Cascades, CountEverySampleAsOneAndKeepItsColour) {
  const Cascades cascades({.start = 0.5, .base = 5, .kappa = 1}, 3);
  for (float v = 0.5f; v < 1e7f; v *= 1.37f) {
    const Spectrum sample = Spectrum(0.3f, 1, 2.5f) * (v / Spectrum(0.3f, 1, 2.5f).luminance());
    std::vector<double> layers(3 + Cascades::kCount * kChannels);
    cascades.add(layers, sample);
    double count = 0;
    Spectrum sum;
    for (size_t j = 0; j < Cascades::kCount; ++j) {
      count += cascades.count(layers, j);
      for (int c = 0; c < kChannels; ++c)
        sum[c] += static_cast<float>(layers[cascades.channel(j) + static_cast<size_t>(c)]);
    }
    EXPECT_NEAR(count, 1, 2e-6) << v;
    const auto top = static_cast<float>(cascades.brightness(Cascades::kCount - 1));
    const float kept = std::min(1.0f, top / v);
    for (int c = 0; c < kChannels; ++c) EXPECT_NEAR(sum[c], sample[c] * kept, 1e-5f * sample[c]) << v;
  }
}

TEST(Cascades, CountDarkSamplesByTheirBrightness) {
  std::vector<double> layers(Cascades::kCount * kChannels);
  const Cascades cascades(kPaper);
  for (const float v : {0.25f, 0.0f, 0.5f}) cascades.add(layers, Spectrum(v));
  EXPECT_NEAR(cascades.count(layers, 0), 0.75, 1e-6);
  EXPECT_EQ(cascades.count(layers, 1), 0);
}

TEST(Cascades, AreFoundBehindOtherLayersAndOnlyWhereTheyAre) {
  std::vector<std::string> names = Cascades::layer_names();
  names.insert(names.begin(), {"albedo.R", "albedo.G"});
  EXPECT_EQ(Cascades::in(Film({1, 1}, names), kPaper)->channel(1), 5u);
  EXPECT_FALSE(Cascades::in(Film({1, 1}, names), std::nullopt));
  EXPECT_FALSE(Cascades::in(Film({1, 1}, {"albedo.R"}), kPaper));
  const Film film({1, 1}, names);
  EXPECT_EQ(with_layers(film_to_image(film, false), film).channel_names(),
            (std::vector<std::string>{"R", "G", "B", "albedo.R", "albedo.G"}));
}

TEST(OutlierRejection, KeepsASmoothPictureToTheBit) {
  for (const uint64_t samples : {1, 2, 3, 4, 16, 64}) {
    EXPECT_TRUE(keeps_the_mean(develop(expose(ramp, samples)))) << samples;
    for (const double kappa : {0.1, 4.0, 1e6}) {
      const OutlierSettings other{.start = 0.01, .base = 3, .kappa = kappa};
      EXPECT_TRUE(keeps_the_mean(develop(expose(ramp, samples, {kSide, kSide}, other), other))) << samples;
    }
  }
}

TEST(OutlierRejection, TakesPlantedFirefliesAway) {
  // One pixel in a hundred has a sample of 50 ... 50,000 among 16.
  const auto source = [](size_t pixel, uint64_t sample) {
    const bool firefly = pixel % 101 == 50 && sample == 5;
    return Spectrum(firefly ? 50 * std::pow(1000.0f, random(pixel, 99)) : 0.4f + 0.2f * random(pixel, sample));
  };
  const Image image = develop(expose(source, 16));
  EXPECT_GT(std::ranges::max(image.channel("unweighted.G")), 300);
  EXPECT_LT(std::ranges::max(image.channel("G")), 0.6f);
  EXPECT_GT(std::ranges::min(image.channel("G")), 0.4f);
  EXPECT_NEAR(mean(image.channel("G")), 0.5, 0.01);
  EXPECT_GT(rejected_share(image), 0.85);
  EXPECT_EQ(image.channel("unweighted.R")[50], film_to_image(expose(source, 16), false).channel("R")[50]);
}

TEST(OutlierRejection, NoticesALadderThatTheSamplesWereNotSortedBy) {
  // Planted: with counts that are wrong by a factor of 64 fireflies look like a crowd.
  const auto source = [](size_t pixel, uint64_t sample) {
    return Spectrum(pixel % 101 == 50 && sample == 5 ? 3000.0f : 0.5f);
  };
  EXPECT_GT(std::ranges::max(develop(expose(source, 16), {.start = 1.0 / 64}).channel("G")), 100);
}

TEST(OutlierRejection, TendsToTheMeanAsSamplesGrow) {
  // A rare bright event on a dim ground, as a small caustic: half of the light comes from 1 sample in 200.
  const auto source = [](size_t pixel, uint64_t sample) {
    return Spectrum(random(pixel, sample) < 0.005f ? 100.0f : 0.5f);
  };
  const double expected = 0.005 * 100 + 0.995 * 0.5;
  double bias[4], noise[4], plain_noise[4];
  for (size_t step = 0; step < 4; ++step) {
    const Image image = develop(expose(source, 16ull << (3 * step)));  // 16 to 8192
    bias[step] = mean(image.channel("unweighted.G")) - mean(image.channel("G"));
    const auto squared_error = [&](const char* channel) {
      double sum = 0;
      for (const float v : image.channel(channel)) sum += (static_cast<double>(v) - expected) * (v - expected);
      return sum / static_cast<double>(image.pixel_count());
    };
    noise[step] = squared_error("G");
    plain_noise[step] = squared_error("unweighted.G");
  }
  EXPECT_GT(bias[0], 0.3);
  EXPECT_LT(bias[1], 0.9 * bias[0]);
  EXPECT_LT(bias[2], 0.05);
  EXPECT_EQ(bias[3], 0);
  EXPECT_LT(noise[0], 0.2 * plain_noise[0]);
  EXPECT_LT(noise[1], 0.8 * plain_noise[1]);

  // A higher kappa asks for more samples of a kind.
  const OutlierSettings wary{.kappa = 16};
  EXPECT_LT(mean(develop(expose(source, 1024, {kSide, kSide}, wary), wary).channel("G")), expected - 0.1);
}

TEST(OutlierRejection, LosesNothingBeyondTheLadder) {
  const OutlierSettings low{.start = 1e-3, .base = 2};  // ends at 0.128
  const auto sun = [](size_t, uint64_t) { return Spectrum(2e4f, 1e4f, 5e3f); };
  EXPECT_TRUE(keeps_the_mean(develop(expose(sun, 16, {5, 5}, low), low)));
  const auto firefly = [](size_t pixel, uint64_t sample) {
    return Spectrum(pixel == 12 && sample == 3 ? 1e7f : 0.05f);
  };
  const Image image = develop(expose(firefly, 16, {5, 5}, low), low);
  EXPECT_LT(image.channel("G")[12], 0.06f);
  EXPECT_GT(image.channel("G")[12], 0.04f);
}

TEST(OutlierRejection, KeepsADetailOfOnePixelThatAllItsSamplesSee) {
  const auto lamp = [](size_t pixel, uint64_t) { return Spectrum(pixel == 12 ? 200.0f : 0.1f); };
  EXPECT_TRUE(keeps_the_mean(develop(expose(lamp, 32, {5, 5}))));
  // So few could be chance: the block has not seen one sample like them per pixel.
  EXPECT_LT(develop(expose(lamp, 8, {5, 5})).channel("G")[12], 1);
}

TEST(OutlierRejection, WorksAtTheBorderAndOnTheSmallestFilm) {
  const auto corner = [](size_t pixel, uint64_t sample) {
    return Spectrum(pixel == 0 && sample == 0 ? 1000.0f : 0.25f);
  };
  EXPECT_LT(develop(expose(corner, 16, {3, 3})).channel("G")[0], 0.4f);
  EXPECT_LT(develop(expose(corner, 16, {1, 1})).channel("G")[0], 0.4f);
  EXPECT_EQ(develop(Film({2, 2}, Cascades::layer_names())).channel("G")[3], 0);
}

TEST(OutlierRejection, WithoutCascadesLeavesTheMean) {
  Film film({2, 2});
  film.pixel(1).add({Spectrum(1000.0f)});
  film.add_samples(16);
  EXPECT_TRUE(keeps_the_mean(develop(film)));
}

}  // namespace
}  // namespace turbid
