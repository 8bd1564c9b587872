// The table of measured media: complete, plausible, and consistent between sources that measured the same.
#include "medium/materials.h"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>

namespace turbid {
namespace {

TEST(Materials, HasTheMediaOfItsSources) {
  std::map<std::string_view, int> count;
  for (const Material& m : materials()) ++count[m.source.substr(0, 4)];
  EXPECT_EQ(count["Wang"], 5);
  EXPECT_EQ(count["Jens"], 12);
  EXPECT_EQ(count["Nara"], 35);
}

TEST(Materials, AreValidMediaWithUniqueNames) {
  std::set<std::string_view> names;
  for (const Material& m : materials()) {
    EXPECT_TRUE(names.insert(m.name).second) << m.name;
    for (int c = 0; c < kChannels; ++c) {
      EXPECT_GE(m.sigma_s[c], 0) << m.name;
      EXPECT_GE(m.sigma_a[c], 0) << m.name;
      EXPECT_GT(m.sigma_s[c] + m.sigma_a[c], 0) << m.name;
      EXPECT_LT(std::abs(m.g[c]), 1) << m.name;
    }
    EXPECT_TRUE(!m.reduced || m.g == Spectrum()) << m.name << ": a reduced coefficient belongs to an isotropic medium";
  }
}

TEST(Materials, AreFoundByNameWhateverTheCase) {
  EXPECT_EQ(find_material("S1 Wax"), &materials()[1]);
  EXPECT_EQ(find_material("s1 wax"), &materials()[1]);
  EXPECT_EQ(find_material("head & shoulders shampoo")->name, "Head & Shoulders Shampoo");
  EXPECT_EQ(find_material("Wax "), nullptr);
  EXPECT_EQ(find_material(""), nullptr);
}

/// The same medium, up to the digits that S1 prints of mean free path and albedo?
bool repeats(const Material& s1, const Material& original) {
  for (int c = 0; c < kChannels; ++c) {
    const float a = s1.sigma_s[c] + s1.sigma_a[c], b = original.sigma_s[c] + original.sigma_a[c];
    if (std::abs(1 / a - 1 / b) > 0.0055f || std::abs(s1.sigma_s[c] / a - original.sigma_s[c] / b) > 0.00105f)
      return false;
  }
  return true;
}

TEST(Materials, S1RepeatsJensenToItsDigits) {
  EXPECT_TRUE(repeats(*find_material("S1 Skin"), *find_material("Skin1")));
  EXPECT_TRUE(repeats(*find_material("S1 Marble"), *find_material("Marble")));
  // Planted: a wrong digit in one channel.
  Material wrong = *find_material("S1 Marble");
  wrong.sigma_s[1] *= 1.04f;
  EXPECT_FALSE(repeats(wrong, *find_material("Marble")));
}

TEST(Materials, NarasimhansScatteringIsNotReduced) {
  // Reduced, this is what is elsewhere shipped under the name: sigma_s (1 - g) = 0.89187, 1.5136, 2.532 per mm.
  const Material* milk = find_material("Lowfat Milk");
  ASSERT_TRUE(milk && !milk->reduced);
  const Spectrum reduced = milk->sigma_s * (Spectrum(1.0f) - milk->g);
  EXPECT_NEAR(reduced[0], 0.89187f, 1e-4f);
  EXPECT_NEAR(reduced[1], 1.5136f, 1e-4f);
  EXPECT_NEAR(reduced[2], 2.532f, 1e-3f);
  // As measured: 16 ml in 23 l of water have an extinction of 0.009126, 0.010748 and 0.0125 per mm.
  EXPECT_NEAR((milk->sigma_s[0] + milk->sigma_a[0]) * 16 / 23000, 0.009126f, 1e-6f);
}

}  // namespace
}  // namespace turbid
