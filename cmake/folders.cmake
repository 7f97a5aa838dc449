# mote_folder(NAME [STATIC] [FOLDERS folders...] [FILES regex] [WITHOUT regex] PUBLIC libs... PRIVATE libs...
#             [INTERNAL libs...] [ALONE regexes...] [COMMAND_LINE regex]): the library mote_NAME of every .cpp below
# NAME/, or below the folders, whose path matches FILES and does not match WITHOUT. Executables that live beside a
# library (main_*.cpp) are left out. STATIC: also where the others are shared. INTERNAL: what only its own compilation
# needs (options, libraries of headers), and no program that links it. ALONE and COMMAND_LINE: see mote_sources in
# units.cmake. Others call it mote::NAME (package.cmake).

# What mote's own files are compiled with. It stays inside: libraries take it by $<BUILD_INTERFACE:...>, privately.
add_library(mote_options INTERFACE)
target_include_directories(mote_options INTERFACE ${PROJECT_SOURCE_DIR})
target_compile_definitions(mote_options INTERFACE GLM_FORCE_CTOR_INIT MOTE_VERSION="${PROJECT_VERSION}")
target_compile_options(mote_options INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
                       -Wno-unknown-pragmas -fno-math-errno -fno-trapping-math)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # GCC 12 sees overlaps in std::string's assignments, and gaps in std::regex under sanitizers, that are not there.
  target_compile_options(mote_options INTERFACE -Wno-restrict)
  if(MOTE_SANITIZE)
    target_compile_options(mote_options INTERFACE -Wno-maybe-uninitialized)
  endif()
endif()
if(MOTE_WERROR)
  target_compile_options(mote_options INTERFACE -Werror)
endif()
if(MOTE_ARCH)
  target_compile_options(mote_options INTERFACE -march=${MOTE_ARCH})
endif()
# Contraction into fused multiply-adds would let one source give two pictures on two compilers.
target_compile_options(mote_options INTERFACE -ffp-contract=off)
if(MOTE_SANITIZE)
  target_compile_options(mote_options INTERFACE -fsanitize=${MOTE_SANITIZE} -fno-omit-frame-pointer)
  target_link_options(mote_options INTERFACE -fsanitize=${MOTE_SANITIZE})
endif()

# What reaches whoever links a library of mote: the standard, what decides the layout of types, and where the headers
# are. Headers in the form in which others include them, <mote/...>, are in build/.../include (package.cmake).
add_library(mote_api INTERFACE)
target_compile_features(mote_api INTERFACE cxx_std_20)
target_compile_definitions(mote_api INTERFACE GLM_FORCE_CTOR_INIT)
if(NOT PROJECT_IS_TOP_LEVEL)
  target_include_directories(mote_api INTERFACE $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include>)
endif()

function(mote_folder name)
  cmake_parse_arguments(ARG "STATIC" "COMMAND_LINE;FILES;WITHOUT" "FOLDERS;PUBLIC;PRIVATE;INTERNAL;ALONE" ${ARGN})
  if(NOT ARG_FOLDERS)
    set(ARG_FOLDERS ${name})
  endif()
  list(TRANSFORM ARG_FOLDERS REPLACE "(.+)" "${PROJECT_SOURCE_DIR}/\\1/*.cpp")
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${ARG_FOLDERS})
  list(FILTER sources EXCLUDE REGEX "/main_[^/]*\\.cpp$")
  if(ARG_FILES)
    list(FILTER sources INCLUDE REGEX "${ARG_FILES}")
  endif()
  if(ARG_WITHOUT)
    list(FILTER sources EXCLUDE REGEX "${ARG_WITHOUT}")
  endif()
  if(ARG_STATIC)
    add_library(mote_${name} STATIC)
  else()
    add_library(mote_${name} ${MOTE_LIBRARY_TYPE})
  endif()
  add_library(mote::${name} ALIAS mote_${name})
  set_target_properties(mote_${name} PROPERTIES EXPORT_NAME ${name} DEFINE_SYMBOL "" VERSION ${PROJECT_VERSION}
                        SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  mote_sources(mote_${name} ${sources} ALONE ${ARG_ALONE} COMMAND_LINE ${ARG_COMMAND_LINE})
  list(TRANSFORM ARG_INTERNAL REPLACE "(.+)" "$<BUILD_INTERFACE:\\1>")
  target_link_libraries(mote_${name} PUBLIC mote_api ${ARG_PUBLIC}
                        PRIVATE $<BUILD_INTERFACE:mote_options> ${ARG_INTERNAL} ${ARG_PRIVATE})
endfunction()
