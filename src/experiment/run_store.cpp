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

std::string name_of(uint64_t fingerprint) { return fmt::format("{:016x}", fingerprint); }

/// What parse() makes of the file; nothing where it is not there, damaged, of another fingerprint, or empty.
template <class T, class Parse>
std::optional<T> read(const std::string& path, uint64_t fingerprint, const Parse& parse) {
  if (!fs::exists(path)) return {};
  try {
    const Json json = Json::parse(read_file(path));
    if (json.at("format") != kFormat || json.at("fingerprint") != name_of(fingerprint)) return {};
    T result = parse(json);
    if (result.empty()) return {};
    return result;
  } catch (const Json::exception&) {
    return {};
  }
}

void write(const std::string& path, uint64_t fingerprint, const char* what, const Json& content) {
  const Json json = {{"format", kFormat}, {"fingerprint", name_of(fingerprint)}, {what, content}};
  write_file_atomically(path, json.dump(1) + "\n");
}

}  // namespace

RunStore::RunStore(std::string folder) : folder_(std::move(folder)) { make_folder(folder_ + "/runs"); }

std::string RunStore::run_path(const std::string& name) const { return folder_ + "/runs/" + name + ".json"; }
std::string RunStore::image_path(const std::string& name) const {
  make_folder(folder_ + "/images");
  return folder_ + "/images/" + name + ".exr";
}

std::optional<Curve> RunStore::find(const std::string& name, uint64_t fingerprint) const {
  return read<Curve>(run_path(name), fingerprint, [](const Json& json) {
    Curve curve;
    for (const Json& point : json.at("curve")) curve.push_back(point_from(point));
    return curve;
  });
}

void RunStore::keep(const std::string& name, uint64_t fingerprint, const Curve& curve) const {
  Json points = Json::array();
  for (const CurvePoint& point : curve) points.push_back(to_json(point));
  write(run_path(name), fingerprint, "curve", points);
}

std::optional<std::string> RunStore::find_text(const std::string& name, uint64_t fingerprint) const {
  return read<std::string>(run_path(name), fingerprint,
                           [](const Json& json) { return json.at("text").get<std::string>(); });
}

void RunStore::keep_text(const std::string& name, uint64_t fingerprint, const std::string& text) const {
  write(run_path(name), fingerprint, "text", text);
}

}  // namespace turbid
