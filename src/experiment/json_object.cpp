#include "experiment/json_object.h"

#include <fmt/format.h>

#include <cmath>

#include "core/error.h"
#include "image/atomic_file.h"
#include "scene/suggestions.h"

namespace turbid {
namespace {

using Json = nlohmann::json;

std::string shown(const Json& value) {
  if (value.is_object() || value.is_array()) return value.is_object() ? "an object" : "a list";
  return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

JsonObject::JsonObject(const Json& value, std::string file, std::string place)
    : value_(&value), file_(std::move(file)), place_(std::move(place)) {
  if (!value.is_object()) fail("expected an object, found " + shown(value));
}

void JsonObject::fail(const std::string& message, const std::string& name) const {
  std::string where = place_;
  if (!name.empty()) where += (where.empty() ? "" : ".") + name;
  throw FileError(file_, where.empty() ? message : where + ": " + message);
}

const Json& JsonObject::value(const std::string& name) const {
  asked_.insert(name);
  const auto found = value_->find(name);
  if (found == value_->end()) fail("'" + name + "' is missing");
  return *found;
}

std::string JsonObject::text(const std::string& name) const {
  const Json& found = value(name);
  if (!found.is_string() || found.get_ref<const std::string&>().empty())
    fail("expected a text, found " + shown(found), name);
  return found;
}

std::string JsonObject::text(const std::string& name, const std::string& otherwise) const {
  asked_.insert(name);
  return has(name) ? text(name) : otherwise;
}

double JsonObject::number(const std::string& name) const {
  const Json& found = value(name);
  if (!found.is_number() || !std::isfinite(found.get<double>())) fail("expected a number, found " + shown(found), name);
  return found;
}

double JsonObject::number(const std::string& name, double otherwise) const {
  asked_.insert(name);
  return has(name) ? number(name) : otherwise;
}

double JsonObject::positive(const std::string& name) const {
  const double found = number(name);
  if (!(found > 0)) fail(fmt::format("expected a number above 0, found {}", found), name);
  return found;
}

int JsonObject::count(const std::string& name) const {
  const double found = number(name);
  if (!(found >= 1 && found <= 1e6) || found != std::floor(found))
    fail(fmt::format("expected a whole number from 1 on, found {}", found), name);
  return static_cast<int>(found);
}

int JsonObject::count(const std::string& name, int otherwise) const {
  asked_.insert(name);
  return has(name) ? count(name) : otherwise;
}

std::vector<std::string> JsonObject::texts(const std::string& name) const {
  std::vector<std::string> result;
  asked_.insert(name);
  if (!has(name)) return result;
  const Json& found = value(name);
  if (!found.is_array()) fail("expected a list of texts, found " + shown(found), name);
  for (const Json& item : found) {
    if (!item.is_string()) fail("expected a list of texts, found " + shown(item) + " in it", name);
    result.push_back(item);
  }
  return result;
}

JsonObject JsonObject::object(const std::string& name) const {
  return {value(name), file_, place_.empty() ? name : place_ + "." + name};
}

std::vector<JsonObject> JsonObject::objects(const std::string& name) const {
  std::vector<JsonObject> result;
  asked_.insert(name);
  if (!has(name)) return result;
  const Json& found = value(name);
  if (!found.is_array()) fail("expected a list, found " + shown(found), name);
  for (size_t i = 0; i < found.size(); ++i)
    result.emplace_back(found[i], file_, fmt::format("{}{}{}[{}]", place_, place_.empty() ? "" : ".", name, i));
  return result;
}

std::vector<std::string> JsonObject::assignments(const std::string& name) const {
  std::vector<std::string> result;
  asked_.insert(name);
  if (!has(name)) return result;
  const Json& found = value(name);
  if (!found.is_object()) fail("expected an object, found " + shown(found), name);
  for (const auto& [key, item] : found.items()) {
    if (!item.is_string() && !item.is_number() && !item.is_boolean())
      fail("expected a text or a number for '" + key + "', found " + shown(item), name);
    result.push_back(key + "=" + (item.is_string() ? item.get<std::string>() : item.dump()));
  }
  return result;
}

void JsonObject::finish() const {
  const std::vector<std::string> names(asked_.begin(), asked_.end());
  for (const auto& [name, item] : value_->items())
    if (!asked_.contains(name)) fail("unknown name '" + name + "'" + suggestion(name, names));
}

Json read_json(const std::string& path) {
  try {
    return Json::parse(read_file(path));
  } catch (const Json::parse_error& error) {
    // "[json.exception.parse_error.101] parse error at line 3, column 5: syntax error ..."
    const std::string message = error.what();
    const size_t at = message.find("at line");
    throw FileError(path, "is not JSON: " + (at == std::string::npos ? message : message.substr(at)));
  }
}

}  // namespace turbid
