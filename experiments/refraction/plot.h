#pragma once
#include <string>
#include <vector>

namespace turbid::experiments {

struct Curve {
  std::string name;
  std::vector<double> x, y;
};

/// Writes curves of equal length over the same x as NAME.csv, and as polylines with axes from 0 to the largest value as
/// NAME.svg. Throws FileError.
void write_plot(const std::string& name, const std::string& title, const std::string& x_label,
                const std::vector<Curve>& curves);

}  // namespace turbid::experiments
