#include "renders.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace turbid::bench {
namespace {

std::string shell_word(const std::filesystem::path& path) {
  std::string text = "'";
  for (const char c : path.string()) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

void run(const std::string& command) {
  if (std::system(command.c_str()) != 0) throw std::runtime_error("failed: " + command);
}

nlohmann::json read_json(const std::filesystem::path& path) {
  std::ifstream in(path);
  return nlohmann::json::parse(in);
}

/// A folder that goes when the measurement is over.
class WorkFolder {
 public:
  WorkFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "turbid-bench-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make a temporary folder");
    path_ = name;
  }
  ~WorkFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;
  std::filesystem::path operator/(const char* name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

}  // namespace

RenderResult measure_render(const std::string& program, const std::string& scene, int samples_per_pixel) {
  const WorkFolder work;
  RenderResult result;
  result.scene = std::filesystem::path(scene).stem().string();
  for (const int seed : {1, 2}) {
    const std::string name = seed == 1 ? "a" : "b";
    const auto image = work / (name + ".exr").c_str(), statistics = work / (name + ".json").c_str();
    run(fmt::format("{} render {} -o {} --spp {} --seed {} --json {} --quiet", shell_word(program), shell_word(scene),
                    shell_word(image), samples_per_pixel, seed, shell_word(statistics)));
    const nlohmann::json json = read_json(statistics);
    result.samples += json.at("samples").get<unsigned long long>();
    result.seconds += json.at("wall_seconds").get<double>();
    result.peak_memory = std::max(result.peak_memory, json.at("peak_memory_bytes").get<unsigned long long>());
  }
  result.samples_per_second = static_cast<double>(result.samples) / result.seconds;

  const auto difference = work / "difference.json";
  run(fmt::format("{} compare {} {} --json > {}", shell_word(program), shell_word(work / "a.exr"),
                  shell_word(work / "b.exr"), shell_word(difference)));
  result.rmse = read_json(difference).at("rmse").get<double>() * std::sqrt(0.5);
  result.efficiency = result.rmse * result.rmse * result.seconds / 2;
  return result;
}

}  // namespace turbid::bench
