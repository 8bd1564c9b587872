# turbid_room(NAME BELOW rooms... LINK libs... PRIVATE_LINK libs...)
#
# One folder of src/ is one static library that can include only the rooms named after BELOW (and, through them, those
# further down): headers are found through a per-room link farm of include folders, so an upward include does not build.
add_library(turbid_options INTERFACE)
target_compile_options(turbid_options INTERFACE
  -Wall -Wextra -Wconversion -Wshadow $<$<BOOL:${TURBID_WERROR}>:-Werror>
  -fno-math-errno -fno-trapping-math
  $<$<BOOL:${TURBID_NATIVE}>:-march=native>)

function(turbid_room name)
  cmake_parse_arguments(ROOM "" "" "BELOW;LINK;PRIVATE_LINK" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/src/${name}/*.cpp)
  if(NOT sources)  # a room of headers only, or not furnished yet
    set(sources ${CMAKE_BINARY_DIR}/empty.cpp)
    if(NOT EXISTS ${sources})
      file(WRITE ${sources} "")
    endif()
  endif()
  add_library(turbid_${name} STATIC ${sources})
  # include/<room>/<room> -> src/<room>: a room's headers are visible to exactly those targets that link it.
  set(door ${CMAKE_BINARY_DIR}/include/${name})
  file(MAKE_DIRECTORY ${door})
  file(CREATE_LINK ${CMAKE_SOURCE_DIR}/src/${name} ${door}/${name} SYMBOLIC)
  target_include_directories(turbid_${name} PUBLIC ${door})
  target_link_libraries(turbid_${name} PRIVATE turbid_options)
  foreach(below ${ROOM_BELOW})
    target_link_libraries(turbid_${name} PUBLIC turbid_${below})
  endforeach()
  target_link_libraries(turbid_${name} PUBLIC ${ROOM_LINK} PRIVATE ${ROOM_PRIVATE_LINK})
endfunction()

# turbid_tests(ROOM): one test program per room, from tests/ROOM/*.cpp.
function(turbid_tests name)
  cmake_parse_arguments(TEST "" "" "LINK" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/tests/${name}/*.cpp)
  if(NOT sources)
    return()
  endif()
  add_executable(test_${name} ${sources})
  target_include_directories(test_${name} PRIVATE ${CMAKE_SOURCE_DIR}/tests)
  target_link_libraries(test_${name} PRIVATE turbid_options turbid_${name} turbid_testing ${TEST_LINK})
  gtest_discover_tests(test_${name} TEST_PREFIX ${name}. DISCOVERY_TIMEOUT 60)
endfunction()
