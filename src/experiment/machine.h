#pragma once
#include <string>

namespace turbid {

/// The processor's name, how many threads are used, and the operating system: what times depend on.
std::string describe_machine();

/// Now, in universal time: "2026-01-31 17:05 UTC".
std::string describe_now();

}  // namespace turbid
