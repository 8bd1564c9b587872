#pragma once
#include <gtest/gtest.h>

#include <string>

#include "scene/document.h"
#include "scene/loader.h"

namespace turbid::testing {

/// A scene of version 3.0.0 with this content; its first line is line 2 of "test.xml".
inline std::string scene_of(const std::string& content) {
  return "<scene version=\"3.0.0\">\n" + content + "\n</scene>";
}

inline SceneDocument read(const std::string& content, const Overrides& overrides = {}) {
  return read_document_from_string(scene_of(content), "test.xml", overrides);
}

/// What an action complains about, with its exit code before it: "3 test.xml:2:1: ...". Empty when it does not.
template <class Action>
std::string complaint(const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    return std::to_string(error.exit_code()) + " " + error.what();
  }
  return {};
}

/// The complaint about a scene text, read only or loaded whole.
inline std::string read_complaint(const std::string& content, const Overrides& overrides = {}) {
  return complaint([&] { read(content, overrides); });
}
inline std::string load_complaint(const std::string& content, const Overrides& overrides = {}) {
  return complaint([&] { load_scene_from_string(scene_of(content), "test.xml", overrides); });
}

/// The value of that name in the first plugin of the scene.
template <class T>
T first_value(const SceneDocument& document, const std::string& name) {
  for (const NamedValue& value : document.root->children.at(0).node->values)
    if (value.name == name) return std::get<T>(value.value);
  throw std::runtime_error("no value " + name);
}

}  // namespace turbid::testing
