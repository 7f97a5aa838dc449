# Less to parse. Most of a small file's time goes into the headers of others: so the files of a folder of the
# libraries are compiled together, a few at a time (MOTE_UNITY), and the test files, whose helpers share names freely,
# read precompiled headers (MOTE_PCH). The preset `alone` has both off and compiles every header on its own besides:
# it shows that each file includes what it uses.

option(MOTE_UNITY "Compile the files of a folder of the libraries together, a few at a time" ON)
option(MOTE_PCH "Precompile the headers of others for the tests" ON)
option(MOTE_HEADERS_ALONE "Compile every header on its own as well" OFF)
set(MOTE_UNIT_FILES 8 CACHE STRING "How many files are compiled together at most (MOTE_UNITY)")

# mote_unit(OUT path sources...): a file that includes these sources, by their path from the root of the project, so
# that a cache finds the same unit in every checkout.
function(mote_unit out path)
  set(content "")
  foreach(source ${ARGN})
    file(RELATIVE_PATH file ${PROJECT_SOURCE_DIR} ${source})
    string(APPEND content "#include \"${file}\"\n")
  endforeach()
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/units/${path}.cpp CONTENT "${content}" @ONLY)
  set(${out} ${PROJECT_BINARY_DIR}/units/${path}.cpp PARENT_SCOPE)
endfunction()

# mote_units(OUT name sources...): units of at most MOTE_UNIT_FILES sources of one folder each.
function(mote_units out name)
  set(folders "")
  foreach(source ${ARGN})
    get_filename_component(folder ${source} DIRECTORY)
    file(RELATIVE_PATH folder ${PROJECT_SOURCE_DIR} ${folder})
    list(APPEND folders ${folder})
    list(APPEND files_${folder} ${source})
  endforeach()
  list(REMOVE_DUPLICATES folders)
  set(units "")
  foreach(folder ${folders})
    # As even as possible: 9 files of at most 8 are 5 and 4.
    list(LENGTH files_${folder} count)
    math(EXPR parts "(${count} + ${MOTE_UNIT_FILES} - 1) / ${MOTE_UNIT_FILES}")
    math(EXPR size "(${count} + ${parts} - 1) / ${parts}")
    set(first 0)
    while(first LESS count)
      list(SUBLIST files_${folder} ${first} ${size} files)
      mote_unit(unit ${name}/${folder}_${first} ${files})
      list(APPEND units ${unit})
      math(EXPR first "${first} + ${size}")
    endwhile()
  endforeach()
  set(${out} ${units} PARENT_SCOPE)
endfunction()

# Command lines are read once, and CLI11's templates take nearly twice the time to compile at -O3.
function(mote_command_line)
  set_source_files_properties(${ARGN} PROPERTIES COMPILE_OPTIONS -O1)
endfunction()

# mote_sources(TARGET sources... [ALONE regexes...] [COMMAND_LINE regex]): gives sources to a target, together where
# MOTE_UNITY allows. Files that match a regex of ALONE are compiled on their own; files that match COMMAND_LINE read
# command lines with CLI11 and are one unit.
function(mote_sources target)
  cmake_parse_arguments(ARG "" "COMMAND_LINE" "ALONE" ${ARGN})
  set(together ${ARG_UNPARSED_ARGUMENTS})
  if(ARG_COMMAND_LINE)
    set(command_line ${together})
    list(FILTER command_line INCLUDE REGEX "${ARG_COMMAND_LINE}")
    list(FILTER together EXCLUDE REGEX "${ARG_COMMAND_LINE}")
    if(MOTE_UNITY)
      mote_unit(command_line ${target}/command_line ${command_line})
    endif()
    mote_command_line(${command_line})
    target_sources(${target} PRIVATE ${command_line})
  endif()
  if(NOT MOTE_UNITY)
    target_sources(${target} PRIVATE ${together})
    return()
  endif()
  foreach(regex ${ARG_ALONE})
    set(alone ${together})
    list(FILTER alone INCLUDE REGEX "${regex}")
    list(FILTER together EXCLUDE REGEX "${regex}")
    target_sources(${target} PRIVATE ${alone})
  endforeach()
  mote_units(units ${target} ${together})
  target_sources(${target} PRIVATE ${units})
endfunction()

# Every header on its own: a file that includes nothing else, for each, compiled with what the libraries may use.
function(mote_headers_alone)
  file(GLOB_RECURSE headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/*.h)
  set(sources "")
  foreach(header ${headers})
    file(RELATIVE_PATH path ${PROJECT_SOURCE_DIR} ${header})
    if(path MATCHES "^(core|media|lights|compensation|gathering|screenspace|integrators|session|trade|plugins|apps|tools|tests|experiments)/")
      mote_unit(source headers/${path} ${header})
      list(APPEND sources ${source})
    endif()
  endforeach()
  add_library(mote_headers_alone OBJECT ${sources})
  target_link_libraries(mote_headers_alone PRIVATE mote_options mote_integrators mote_test_support mote_nanovdb CLI11::CLI11
                        OpenEXR::OpenEXR PNG::PNG JPEG::JPEG pugixml::pugixml assimp::assimp)
  target_compile_options(mote_headers_alone PRIVATE -O0)
endfunction()
