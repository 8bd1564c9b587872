#pragma once
#include <cstdlib>
#include <filesystem>
#include <string>

namespace turbid::testing {

/// Where another renderer's own test scenes stand, with their references: the environment variable TURBID_PEER_SCENES,
/// or a folder beside the checkout. It need not exist: tests that use it skip with peer_scenes_absent() as their
/// message.
inline std::filesystem::path peer_scenes() {
  const char* set = std::getenv("TURBID_PEER_SCENES");
  if (set) return set;
  const auto root = std::filesystem::path(__FILE__).parent_path().parent_path().parent_path();
  return root / "../shared/peer-scenes/mitsuba3";
}

inline std::string peer_scenes_absent() {
  return "no peer scenes at " + peer_scenes().string() + " (TURBID_PEER_SCENES names their folder)";
}

}  // namespace turbid::testing
