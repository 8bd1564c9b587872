# turbid_room(NAME BELOW rooms... LINK libs... PRIVATE_LINK libs... EXCLUDE files...)
#
# One folder of src/ is one static library that can include only the rooms named after BELOW (and, through them, those
# further down): a room's headers are seen through a door of its own, build/include/<room>/<room> -> src/<room>, which
# opens to exactly those targets that link it. An upward include does not build.
function(turbid_room name)
  cmake_parse_arguments(ROOM "" "" "BELOW;LINK;PRIVATE_LINK;EXCLUDE" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/src/${name}/*.cpp)
  foreach(file ${ROOM_EXCLUDE})
    list(REMOVE_ITEM sources ${CMAKE_SOURCE_DIR}/src/${name}/${file})
  endforeach()
  if(NOT sources)  # a room of headers only, or not furnished yet
    set(sources ${CMAKE_BINARY_DIR}/empty.cpp)
    if(NOT EXISTS ${sources})
      file(WRITE ${sources} "")
    endif()
  endif()
  set_property(GLOBAL APPEND PROPERTY TURBID_ROOMS ${name})
  add_library(turbid_${name} STATIC ${sources})
  set(door ${CMAKE_BINARY_DIR}/include/${name})
  file(MAKE_DIRECTORY ${door})
  file(CREATE_LINK ${CMAKE_SOURCE_DIR}/src/${name} ${door}/${name} SYMBOLIC)
  target_include_directories(turbid_${name} PUBLIC
    $<BUILD_INTERFACE:${door}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/turbid>)
  target_link_libraries(turbid_${name} PRIVATE $<BUILD_INTERFACE:turbid_options>)
  list(TRANSFORM ROOM_BELOW PREPEND turbid_)
  target_link_libraries(turbid_${name} PUBLIC ${ROOM_BELOW} ${ROOM_LINK} PRIVATE ${ROOM_PRIVATE_LINK})
  set_target_properties(turbid_${name} PROPERTIES EXPORT_NAME ${name})

  install(TARGETS turbid_${name} EXPORT turbid ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}/turbid)
  install(DIRECTORY src/${name} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/turbid FILES_MATCHING PATTERN "*.h")
endfunction()

# turbid_tests(ROOM [LINK libs...]): one test program per room, from tests/ROOM/*.cpp. Tests whose suite is named Slow...
# carry the label `slow`, all others `quick`.
function(turbid_tests name)
  cmake_parse_arguments(TEST "" "" "LINK" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/tests/${name}/*.cpp)
  if(NOT sources)
    return()
  endif()
  add_executable(test_${name} ${sources})
  target_link_libraries(test_${name} PRIVATE turbid_test_options turbid_testing ${TEST_LINK})
  if(TARGET turbid_${name})
    target_link_libraries(test_${name} PRIVATE turbid_${name})
  endif()
  target_precompile_headers(test_${name} REUSE_FROM turbid_testing)
  gtest_discover_tests(test_${name} TEST_PREFIX ${name}. TEST_FILTER "-Slow*" DISCOVERY_TIMEOUT 120
    PROPERTIES LABELS quick TIMEOUT 300)
  gtest_discover_tests(test_${name} TEST_PREFIX ${name}. TEST_FILTER "Slow*" TEST_LIST test_${name}_slow
    DISCOVERY_TIMEOUT 120 PROPERTIES LABELS slow TIMEOUT 3600)
endfunction()
