// The entry of every experiment: what goes wrong is said in a line.
#include <fmt/format.h>

#include "methods.h"

int main(int argc, char** argv) {
  try {
    return turbid::experiments::run(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
