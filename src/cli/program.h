#pragma once

namespace turbid {

/// The whole program. Returns the exit code: 0 done, 1 a mistake in the program or no memory, 2 wrong usage, 3 scene
/// error, 4 file error, 130 interrupted. No exception leaves it.
int run_program(int argc, const char* const* argv);

}  // namespace turbid
