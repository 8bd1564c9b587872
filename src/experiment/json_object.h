#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace turbid {

/// An object of a JSON file that is read strictly: a missing or wrong value is a FileError that says where it stands
/// and what was expected, and so is a name that nobody asked for (`finish`).
class JsonObject {
 public:
  /// `place`: what the object is called in messages ("scenes[0]"), or empty for the whole file. `value` must live on.
  JsonObject(const nlohmann::json& value, std::string file, std::string place);

  bool has(const std::string& name) const { return value_->contains(name); }
  std::string text(const std::string& name) const;
  std::string text(const std::string& name, const std::string& otherwise) const;
  double number(const std::string& name) const;
  double number(const std::string& name, double otherwise) const;
  double positive(const std::string& name) const;
  int count(const std::string& name) const;  ///< a whole number from 1 to a million
  int count(const std::string& name, int otherwise) const;
  std::vector<std::string> texts(const std::string& name) const;  ///< empty when it is not there
  JsonObject object(const std::string& name) const;
  std::vector<JsonObject> objects(const std::string& name) const;  ///< empty when it is not there
  /// An object of plain values as "name=value" texts; empty when it is not there.
  std::vector<std::string> assignments(const std::string& name) const;

  /// A FileError about this object, or about one of its values.
  [[noreturn]] void fail(const std::string& message, const std::string& name = {}) const;
  /// Throws unless every name was asked for.
  void finish() const;

 private:
  const nlohmann::json& value(const std::string& name) const;

  const nlohmann::json* value_;
  std::string file_, place_;
  mutable std::set<std::string> asked_;
};

/// The content of a JSON file. Throws FileError, with line and column where it is not JSON.
nlohmann::json read_json(const std::string& path);

}  // namespace turbid
