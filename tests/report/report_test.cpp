// What a report hands to the viewer.
#include "report/report.h"

#include <Imath/half.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "report/base64.h"
#include "testing/temporary_folder.h"

namespace turbid::testing {
namespace {

std::string base64(const std::string& text) {
  return to_base64({reinterpret_cast<const unsigned char*>(text.data()), text.size()});
}

TEST(Base64, EncodesTheExamplesOfTheStandard) {  // RFC 4648, section 10
  const std::pair<const char*, const char*> examples[] = {{"", ""},
                                                          {"f", "Zg=="},
                                                          {"fo", "Zm8="},
                                                          {"foo", "Zm9v"},
                                                          {"foob", "Zm9vYg=="},
                                                          {"fooba", "Zm9vYmE="},
                                                          {"foobar", "Zm9vYmFy"}};
  for (const auto& [plain, encoded] : examples) EXPECT_EQ(base64(plain), encoded);
}

/// The image's values as the viewer reads them.
std::vector<float> decoded(const nlohmann::ordered_json& image) {
  static const std::string kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  uint32_t bits = 0;
  int count = 0;
  for (const char c : image["pixels"].get<std::string>()) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<uint32_t>(kDigits.find(c));
    if ((count += 6) >= 8) bytes += static_cast<char>(bits >> (count -= 8) & 255);
  }
  std::vector<float> values;
  for (size_t i = 0; i + 1 < bytes.size(); i += 2) {
    half value;
    value.setBits(
        static_cast<uint16_t>(static_cast<unsigned char>(bytes[i]) | static_cast<unsigned char>(bytes[i + 1]) << 8));
    values.push_back(value * image["scale"].get<float>());
  }
  return values;
}

ReportImage image_of(const std::vector<float>& red, const std::string& name) {
  ReportImage shown{.name = name, .image = Image(static_cast<int>(red.size()), 1, {"R", "G", "B"})};
  for (size_t i = 0; i < red.size(); ++i) {
    shown.image.channel("R")[i] = red[i];
    shown.image.channel("G")[i] = 2 * red[i];
  }
  return shown;
}

TEST(Report, KeepsPixelsOfAnySize) {
  for (const float size : {1e-3f, 1.0f, 1e4f, 1e7f, 1e20f}) {
    const Report report{.title = "t", .groups = {{"g", {image_of({size, size / 3, 0}, "a")}}}};
    const auto image = to_json(report)["groups"][0]["images"][0];
    const std::vector<float> values = decoded(image);
    ASSERT_EQ(values.size(), 9u);
    const float expected[] = {size, 2 * size, 0, size / 3, 2 * size / 3, 0, 0, 0, 0};
    for (size_t i = 0; i < 9; ++i) EXPECT_NEAR(values[i], expected[i], expected[i] * 0x1p-11f) << size << " " << i;
  }
}

TEST(Report, KeepsWhatIsNotFinite) {
  constexpr float kInf = std::numeric_limits<float>::infinity();
  const Report report{.title = "t", .groups = {{"g", {image_of({kInf, 1}, "a")}}}};
  const std::vector<float> values = decoded(to_json(report)["groups"][0]["images"][0]);
  EXPECT_EQ(values[0], kInf);
  EXPECT_EQ(values[3], 1);
}

TEST(Report, CostIsSquaredErrorTimesTime) {
  ReportImage image = image_of({1}, "a");
  image.metrics.emplace();
  image.metrics->rmse = 0.5;
  image.metrics->psnr = std::numeric_limits<double>::infinity();
  image.seconds = 8;
  const auto metrics = to_json({.title = "t", .groups = {{"g", {image}}}})["groups"][0]["images"][0]["metrics"];
  EXPECT_EQ(metrics["cost"], 2);
  EXPECT_FALSE(metrics.contains("psnr")) << "JSON has no infinity";
}

TEST(Report, CannotEndItsElement) {
  const Report report{.title = "</script><!--", .facts = {{"<b>", "\xff"}}};
  const std::string page = to_html(report, "<p><!--report--></p>");
  EXPECT_TRUE(page.starts_with("<p>{") && page.ends_with("}</p>")) << page;
  EXPECT_EQ(page.find("</script"), std::string::npos) << page;
  const std::string json = page.substr(3, page.size() - 7);
  EXPECT_EQ(nlohmann::json::parse(json)["title"], "</script><!--");
}

TEST(Report, NeedsAViewerWithAPlace) {
  EXPECT_THROW(to_html({.title = "t"}, "<p></p>"), std::invalid_argument);
  const TemporaryFolder folder;
  setenv("TURBID_VIEWER", folder.file("none.html").c_str(), 1);
  EXPECT_THROW(read_viewer(), UsageError);
  unsetenv("TURBID_VIEWER");
}

}  // namespace
}  // namespace turbid::testing
