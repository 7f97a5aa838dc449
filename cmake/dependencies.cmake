# Everything mote is built on, from the packages of Debian 12 or 13 (see ./quickstart for their names).

if(NOT PROJECT_IS_TOP_LEVEL)
  set(CMAKE_FIND_PACKAGE_TARGETS_GLOBAL ON)  # whoever adds mote to his project links what mote links
endif()
find_package(Threads REQUIRED)
# TBB comes before OpenVDB: Debian's FindOpenVDB defines TBB::tbb itself, and TBB's config then refuses.
find_package(TBB CONFIG REQUIRED)
find_package(glm REQUIRED)
find_package(pugixml CONFIG REQUIRED)
# Imath's config names a Python library that only python3-imath installs.
find_package(OpenEXR CONFIG REQUIRED)
find_package(PNG REQUIRED)
find_package(JPEG REQUIRED)
find_package(ZLIB REQUIRED)
find_package(assimp CONFIG REQUIRED)
find_package(nlohmann_json CONFIG REQUIRED)
find_package(fmt CONFIG REQUIRED)
find_package(Eigen3 3.3 REQUIRED NO_MODULE)  # headers, inside lights/selection alone
if(MOTE_BUILD_APPS)
  find_package(CLI11 CONFIG REQUIRED)
endif()

find_package(embree 4 CONFIG QUIET)
if(NOT embree_FOUND)
  find_package(embree 3 CONFIG REQUIRED)
endif()

find_path(MOTE_OPENVDB_MODULE_DIR FindOpenVDB.cmake
          HINTS ${CMAKE_LIBRARY_PATH}
          PATHS /usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/cmake/OpenVDB
                /usr/lib/cmake/OpenVDB /usr/local/lib/cmake/OpenVDB /usr/lib64/cmake/OpenVDB
          REQUIRED)
list(APPEND CMAKE_MODULE_PATH ${MOTE_OPENVDB_MODULE_DIR})
find_package(OpenVDB REQUIRED COMPONENTS openvdb)

# NanoVDB is header-only and ships beside OpenVDB.
find_path(MOTE_NANOVDB_INCLUDE_DIR nanovdb/NanoVDB.h REQUIRED)
add_library(mote_nanovdb INTERFACE)
target_include_directories(mote_nanovdb SYSTEM INTERFACE ${MOTE_NANOVDB_INCLUDE_DIR})
