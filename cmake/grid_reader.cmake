# The helper program that reads VDB files in a process of its own, and a writer of test grids. These are the
# targets that compile OpenVDB's headers, tens of seconds each.

function(mote_openvdb_program name source)
  add_executable(${name} ${PROJECT_SOURCE_DIR}/${source})
  target_link_libraries(${name} PRIVATE mote_options OpenVDB::openvdb TBB::tbb mote_nanovdb nlohmann_json::nlohmann_json)
endfunction()

mote_openvdb_program(mote_grid_reader media/main_grid_reader.cpp)
target_compile_definitions(mote_grid_reader PRIVATE NANOVDB_USE_ZIP)
target_link_libraries(mote_grid_reader PRIVATE ZLIB::ZLIB)
if(MOTE_SANITIZE)
  target_compile_definitions(mote_grid_reader PRIVATE MOTE_SANITIZED)
endif()
add_dependencies(mote_media mote_grid_reader)
target_compile_definitions(mote_media PRIVATE MOTE_GRID_READER_FOLDER="${CMAKE_RUNTIME_OUTPUT_DIRECTORY}")

if(MOTE_BUILD_TESTS)
  mote_openvdb_program(mote_test_grid_writer tests/media/tools/main_write_test_grids.cpp)
  # It writes tiny grids; optimising OpenVDB's templates for that would take most of its time.
  target_compile_options(mote_test_grid_writer PRIVATE -O0)
endif()
