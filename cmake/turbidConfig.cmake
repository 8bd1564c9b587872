# find_package(turbid): the rooms as libraries, turbid::turbid for all of them.
include(CMakeFindDependencyMacro)
foreach(package Threads TBB Imath OpenEXR ZLIB pugixml CLI11 fmt spdlog nlohmann_json)
  find_dependency(${package})
endforeach()
find_dependency(embree 3)
find_dependency(HDF5 COMPONENTS C HL)
include(${CMAKE_CURRENT_LIST_DIR}/turbidTargets.cmake)
