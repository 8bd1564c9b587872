// Integrators against each other, on every scene of the suite: in whole and by scattering order.
#include "integrator/agreement.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>

#include "integrator/suite.h"

namespace turbid::testing {
namespace {

using namespace pieces;

class BdptAgainstVolpath : public ::testing::TestWithParam<SuiteScene> {};
TEST_P(BdptAgainstVolpath, Agrees) {
  const Agreement agreement = compare(observe(GetParam().xml, {"volpath", 32}), observe(GetParam().xml, {"bdpt", 16}));
  std::fputs(agreement.report().c_str(), stderr);
  EXPECT_TRUE(agreement.accepted()) << agreement.report();
}
INSTANTIATE_TEST_SUITE_P(Suite, BdptAgainstVolpath, ::testing::ValuesIn(suite()),
                         [](const auto& instance) {
                           std::string name = instance.param.name;
                           for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
                           return name;
                         });

}  // namespace
}  // namespace turbid::testing
