#pragma once
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "image/image.h"
#include "image/metrics.h"

namespace turbid {

/// Standard errors of numbers in ImageMetrics, over repeated seeds.
struct MetricErrors {
  double rmse = 0, psnr = 0, rel_mse = 0, mean_ratio = 0;
  double cost = 0;  ///< of squared error x time
};

/// One image of a report and what is known of it.
struct ReportImage {
  std::string name;
  Image image;
  bool is_reference = false;
  std::optional<ImageMetrics> metrics{};  ///< against the reference of its group
  std::optional<MetricErrors> errors{};   ///< of the metrics
  std::optional<double> cost{};           ///< squared error x time; else made of metrics->rmse and seconds
  std::optional<double> seconds{};        ///< that it took
  std::optional<double> samples{};        ///< per pixel
};

/// Images of one size that are looked at together.
struct ReportGroup {
  std::string title;
  std::vector<ReportImage> images;
  float exposure = 0;  ///< stops, to begin with
};

/// Curves over a common axis; `low` and `high`, where not empty, are the band of confidence around y.
struct ReportPlot {
  struct Series {
    std::string name;
    std::vector<double> x, y, low{}, high{};
  };
  std::string title, x_label, y_label;
  bool logarithmic = true;
  std::vector<Series> series;
};

struct ReportTable {
  using Cell = std::variant<std::string, double>;
  std::string title;
  std::vector<std::string> columns;
  std::vector<std::vector<Cell>> rows;
};

/// Which image of a group is best, and how far the others are behind: the page begins with it.
struct ReportVerdict {
  std::string place, winner, text;
};

/// A name that is used on the page, and what it means.
struct ReportTerm {
  std::string name, text;
};

/// What one HTML page shows: images, plots, tables, and how it all was made.
struct Report {
  std::string title, subtitle{};
  std::vector<ReportVerdict> verdicts{};  ///< none: the viewer says what it can from the metrics
  std::vector<ReportTable> overview{};    ///< tables that stand before the images
  std::vector<ReportTerm> glossary{};
  std::vector<ReportGroup> groups{};
  std::vector<ReportPlot> plots{};
  std::vector<ReportTable> tables{};
  std::vector<std::pair<std::string, std::string>> facts{};  ///< machine, command line ...
};

/// The names that the viewer reads. Pixels are interleaved half floats in base64, times the power of two `scale`, which
/// keeps the largest finite value of an image in range; values that are not finite stay so.
nlohmann::ordered_json to_json(const Report& report);

/// The report as one page that needs nothing else. `viewer` is the page that viewer/build.mjs makes;
/// std::invalid_argument when it has no place for the report.
std::string to_html(const Report& report, const std::string& viewer);

/// The viewer's page: TURBID_VIEWER of the environment, else where the build or the installation has it. Throws
/// UsageError that says how to make it when there is none.
std::string read_viewer();

}  // namespace turbid
