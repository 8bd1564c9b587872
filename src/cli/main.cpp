#include "cli/program.h"

int main(int argc, char** argv) { return turbid::run_program(argc, argv); }
