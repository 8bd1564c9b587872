// Phase functions as scene files name them: every parameter reaches its class, and what makes no sense is refused.
#include <gtest/gtest.h>

#include "medium/fournier_forand.h"
#include "medium/mie.h"
#include "medium/phase_function.h"
#include "scene/reading.h"
#include "scene/scene.h"

namespace turbid {
namespace {

using testing::load_complaint;
using testing::scene_of;

std::string in_a_medium(const std::string& phase) {
  return "<shape type=\"sphere\"><medium type=\"homogeneous\" name=\"interior\">\n" + phase + "</medium></shape>";
}

std::shared_ptr<const Medium> medium_with(const std::string& phase) {
  return load_scene_from_string(scene_of(in_a_medium(phase)), "test.xml").parts.objects[0].interior;
}

std::string number(const std::string& name, const std::string& value) {
  return "<float name=\"" + name + "\" value=\"" + value + "\"/>";
}

std::string phase(const std::string& type, const std::string& parameters = "") {
  return "<phase type=\"" + type + "\">" + parameters + "</phase>";
}

TEST(Phases, AreMadeWithTheirParameters) {
  const auto mean_cosine = [](const std::string& text) { return medium_with(text)->phase().mean_cosine(); };
  EXPECT_FLOAT_EQ(mean_cosine(phase("two_term_hg", number("w", "0.25") + number("g1", "0.8") + number("g2", "-0.4"))),
                  0.25f * 0.8f - 0.75f * 0.4f);
  EXPECT_NEAR(mean_cosine(phase("two_term_hg", "<string name=\"preset\" value=\"ocean_water\"/>")), 0.9726f, 1e-4f);
  EXPECT_FLOAT_EQ(mean_cosine(phase("forward_hg", number("g", "0"))), 0.5f);
  EXPECT_FLOAT_EQ(mean_cosine(phase("backward_hg", number("g", "0"))), -0.5f);
  EXPECT_FLOAT_EQ(mean_cosine(phase("draine", number("g", "0.5") + number("alpha", "0"))), 0.5f);
  EXPECT_FLOAT_EQ(mean_cosine(phase("draine", number("g", "0.5") + number("alpha", "1"))), 0.5f * 1.7f / 1.5f);
  EXPECT_GT(mean_cosine(phase("mie_fit", number("diameter", "20"))), mean_cosine(phase("mie_fit")));

  const MiePhase mie({.radius = 0.3,
                      .deviation = 0.2,
                      .interior_ior = 1.5,
                      .interior_k = 0.1,
                      .exterior_ior = 1.333,
                      .wavelength = 650});
  EXPECT_NEAR(mean_cosine(phase("mie", number("radius", "0.3") + number("deviation", "0.2") + number("int_ior", "1.5") +
                                           number("k", "0.1") + number("wavelength", "650") +
                                           "<string name=\"ext_ior\" value=\"water\"/>")),
              mie.mean_cosine(), 1e-3f);
  EXPECT_NEAR(mean_cosine(phase("mie")), 0.85f, 0.01f);  // droplets in air

  EXPECT_FLOAT_EQ(mean_cosine(phase("fournier_forand", number("n", "1.04") + number("slope", "3.201"))),
                  FournierForandPhase({1.04, 3.201}).mean_cosine());
  EXPECT_FLOAT_EQ(mean_cosine(phase("fournier_forand", number("backscatter", "0.01"))),
                  FournierForandPhase(FournierForandPhase::from_backscatter(0.01)).mean_cosine());
}

TEST(Phases, ThatMakeNoSenseAreRefused) {
  const auto complaint = [](const std::string& text) { return load_complaint(in_a_medium(text)); };
  EXPECT_EQ(complaint(phase("two_term_hg", number("w", "0.5"))),
            "3 test.xml:3:1: phase 'two_term_hg': needs 'w', 'g1' and 'g2', or a 'preset'");
  EXPECT_EQ(complaint(phase("two_term_hg", "<string name=\"preset\" value=\"ocean_water\"/>" + number("g1", "0"))),
            "3 test.xml:3:94: 'g1' of phase 'two_term_hg' cannot stand beside 'preset'");
  EXPECT_EQ(complaint(phase("two_term_hg", "<string name=\"preset\" value=\"ocean\"/>")),
            "3 test.xml:3:56: 'preset' of phase 'two_term_hg' cannot be 'ocean' (expected one of: ocean_water, "
            "water_droplets)");
  EXPECT_EQ(complaint(phase("forward_hg", number("g", "1"))),
            "3 test.xml:3:49: 'g' of phase 'forward_hg' is 1, expected a number in (-1, 1)");
  EXPECT_EQ(complaint(phase("draine", number("alpha", "-1"))),
            "3 test.xml:3:49: 'alpha' of phase 'draine' is -1, expected a number at least 0");
  EXPECT_EQ(complaint(phase("mie_fit", number("diameter", "60"))),
            "3 test.xml:3:53: 'diameter' of phase 'mie_fit' is 60, expected a number in (0, 50]");
  EXPECT_EQ(complaint(phase("mie", number("radius", "1000") + number("ext_ior", "1"))),
            "3 test.xml:3:1: phase 'mie': the spheres have a size parameter of 11423.973286, which must lie in [0.01, "
            "2000]");
  EXPECT_EQ(complaint(phase("mie", "<string name=\"int_ior\" value=\"watre\"/>")),
            "3 test.xml:3:49: 'int_ior' of phase 'mie' names the unknown material 'watre', did you mean 'water'?");
  EXPECT_EQ(complaint(phase("fournier_forand", number("slope", "3"))),
            "3 test.xml:3:58: 'slope' of phase 'fournier_forand' is 3, expected a number in (3, 5)");
  EXPECT_EQ(complaint(phase("fournier_forand", number("backscatter", "0.01") + number("n", "1.1"))),
            "3 test.xml:3:94: 'n' of phase 'fournier_forand' cannot stand beside 'backscatter'");
}

}  // namespace
}  // namespace turbid
