#pragma once
#include "core/log.h"

/// Warnings would only slow the fuzzer down.
extern "C" int LLVMFuzzerInitialize(int*, char***) {
  turbid::set_log_level(turbid::LogLevel::kQuiet);
  return 0;
}
