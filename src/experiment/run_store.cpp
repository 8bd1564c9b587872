#include "experiment/run_store.h"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/cache_folder.h"
#include "image/atomic_file.h"

namespace turbid {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// Changes with what is kept.
constexpr int kFormat = 1;

Json to_json(const CurvePoint& p) {
  return {{"seconds", p.seconds},
          {"wall", p.wall},
          {"samples", p.samples},
          {"level", p.level},
          {"mse", p.error.mse},
          {"rel_mse", p.error.rel_mse},
          {"mean_ratio", p.error.mean_ratio}};
}

CurvePoint point_from(const Json& json) {
  return {json.at("seconds"),
          json.at("wall"),
          json.at("samples"),
          json.at("level"),
          {json.at("mse"), json.at("rel_mse"), json.at("mean_ratio")}};
}

}  // namespace

RunStore::RunStore(std::string folder) : folder_(std::move(folder)) {
  make_folder(folder_ + "/runs");
  make_folder(folder_ + "/images");
}

std::string RunStore::run_path(const std::string& name) const { return folder_ + "/runs/" + name + ".json"; }
std::string RunStore::image_path(const std::string& name) const { return folder_ + "/images/" + name + ".exr"; }

std::optional<Curve> RunStore::find(const std::string& name, uint64_t fingerprint) const {
  if (!fs::exists(run_path(name))) return {};
  try {
    const Json json = Json::parse(read_file(run_path(name)));
    if (json.at("format") != kFormat || json.at("fingerprint") != fmt::format("{:016x}", fingerprint)) return {};
    Curve curve;
    for (const Json& point : json.at("curve")) curve.push_back(point_from(point));
    if (curve.empty()) return {};
    return curve;
  } catch (const Json::exception&) {
    return {};  // damaged: the run is made again
  }
}

void RunStore::keep(const std::string& name, uint64_t fingerprint, const Curve& curve) const {
  Json points = Json::array();
  for (const CurvePoint& point : curve) points.push_back(to_json(point));
  const Json json = {{"format", kFormat}, {"fingerprint", fmt::format("{:016x}", fingerprint)}, {"curve", points}};
  write_file_atomically(run_path(name), json.dump(1) + "\n");
}

}  // namespace turbid
