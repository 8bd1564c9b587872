#include "image/film.h"

#include <gtest/gtest.h>

#include "image/film_image.h"

namespace turbid {
namespace {

TEST(Film, SumsPassesAndClears) {
  Film total({3, 2}), pass({3, 2});
  pass.pixel(4).add({Spectrum(1, 2, 3), 0.5f});
  pass.add_samples(1);
  total.add(pass);
  total.add(pass);
  EXPECT_EQ(total.samples(), 2u);
  EXPECT_EQ(total.pixel(4).radiance[2], 6);
  EXPECT_EQ(total.pixel(4).squares[1], 8);
  EXPECT_EQ(total.pixel(4).products[0], 4);   // RG
  EXPECT_EQ(total.pixel(4).products[1], 12);  // GB
  EXPECT_EQ(total.pixel(4).products[2], 6);   // BR
  const Image image = film_to_image(total, true);
  EXPECT_EQ(image.channel("G")[4], 2);
  EXPECT_EQ(image.channel("A")[4], 0.5f);
  EXPECT_EQ(image.channel("G")[3], 0);
  total.clear();
  EXPECT_EQ(total.samples(), 0u);
  EXPECT_EQ(total.pixel(4).radiance[2], 0);
}

TEST(Film, SumsLayersToo) {
  const std::vector<std::string> names = {"depth.T", "albedo.R"};
  Film total({3, 2}, names), pass({3, 2}, names);
  pass.layers(4)[1] = 3;
  pass.add_samples(1);
  total.add(pass);
  pass.clear();
  EXPECT_EQ(pass.layers(4)[1], 0);
  pass.layers(4)[1] = 5;
  pass.add_samples(1);
  total.add(pass);
  const Image image = with_layers(film_to_image(total, true), total);
  EXPECT_EQ(image.channel_names(), (std::vector<std::string>{"R", "G", "B", "A", "depth.T", "albedo.R"}));
  EXPECT_EQ(image.channel("albedo.R")[4], 4);
  EXPECT_EQ(image.channel("depth.T")[4], 0);
}

TEST(Film, AnEmptyFilmGivesABlackImage) { EXPECT_EQ(film_to_image(Film({2, 2}), false).channel("R")[0], 0); }

}  // namespace
}  // namespace turbid
