#pragma once
#include <string_view>

namespace turbid {

/// The version of this program, "0.1.0".
std::string_view version();

/// The commit that it was built from, "56fbfe6", with a "+" behind it when files had changed since; empty when unknown
/// (built from an archive, or without git).
std::string_view version_commit();

}  // namespace turbid
