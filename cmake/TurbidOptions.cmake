# How turbid's own code is compiled and linked. Nothing here leaks into what uses the installed libraries.

option(TURBID_NATIVE "Optimise for the processor of this machine (-march=native)" ON)
option(TURBID_LTO "Optimise across files when linking programs (release builds)" ON)
option(TURBID_WERROR "Treat warnings as errors" ON)
set(TURBID_SANITIZE "" CACHE STRING "Sanitizers, as -fsanitize= takes them, e.g. address,undefined")

# Everybody: tests link this, and their programs stay quick to link.
add_library(turbid_common_options INTERFACE)
# Warnings of GCC's optimiser depend on what it happens to inline, so on the processor. Those that are known to be wrong
# (std::string in GCC 12, its bugs 105329 and 105651; Imath's vectors, which begin uninitialised) are off, and the others
# never stop a build.
set(optimiser_warnings -Wno-restrict -Wno-array-bounds -Wno-stringop-overflow -Wno-maybe-uninitialized
  -Wno-error=stringop-overread -Wno-error=dangling-pointer -Wno-error=use-after-free -Wno-error=free-nonheap-object
  -Wno-error=nonnull)
target_compile_options(turbid_common_options INTERFACE
  -Wall -Wextra -Wconversion -Wshadow $<$<BOOL:${TURBID_WERROR}>:-Werror>
  "$<$<CXX_COMPILER_ID:GNU>:${optimiser_warnings}>"
  $<$<CXX_COMPILER_ID:Clang>:-Wno-sign-conversion>  # which GCC does not count among conversions in C++
  -fno-math-errno -fno-trapping-math
  $<$<BOOL:${TURBID_NATIVE}>:-march=native>)

# The rooms, whose objects serve both ways of linking.
add_library(turbid_options INTERFACE)
target_link_libraries(turbid_options INTERFACE turbid_common_options)

# Tests run once: compiling them fast counts for more than their speed.
add_library(turbid_test_options INTERFACE)
target_link_libraries(turbid_test_options INTERFACE turbid_common_options)
target_compile_options(turbid_test_options INTERFACE $<$<CONFIG:Release>:-O1>)

# What is worth optimising as a whole: the program and the benchmarks.
add_library(turbid_program_options INTERFACE)
target_link_libraries(turbid_program_options INTERFACE turbid_options)

if(TURBID_SANITIZE)
  set(flags -fsanitize=${TURBID_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_compile_options(turbid_common_options INTERFACE ${flags})
  target_link_options(turbid_common_options INTERFACE ${flags})
elseif(TURBID_LTO AND CMAKE_BUILD_TYPE STREQUAL Release)
  include(CheckIPOSupported)
  check_ipo_supported(RESULT has_lto OUTPUT why LANGUAGES CXX)
  if(NOT has_lto)
    message(STATUS "No link-time optimisation: ${why}")
  elseif(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    # Fat objects serve both: programs are optimised as a whole, tests link the same libraries as they are.
    target_compile_options(turbid_options INTERFACE -flto=auto -ffat-lto-objects)
    target_link_options(turbid_program_options INTERFACE -flto=auto)
    target_link_options(turbid_test_options INTERFACE -fno-lto)
  else()
    target_compile_options(turbid_options INTERFACE -flto=thin)
    target_link_options(turbid_common_options INTERFACE -flto=thin)
  endif()
endif()
