# mote_folder(NAME [FOLDERS folders...] PUBLIC libs... PRIVATE libs... [ALONE regexes...] [COMMAND_LINE regex]): the
# static library mote_NAME of every .cpp below NAME/, or below the folders. Executables that live beside a library
# (main_*.cpp) are left out. ALONE and COMMAND_LINE: see mote_sources in units.cmake.

add_library(mote_options INTERFACE)
target_include_directories(mote_options INTERFACE ${CMAKE_SOURCE_DIR})
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

function(mote_folder name)
  cmake_parse_arguments(ARG "" "COMMAND_LINE" "FOLDERS;PUBLIC;PRIVATE;ALONE" ${ARGN})
  if(NOT ARG_FOLDERS)
    set(ARG_FOLDERS ${name})
  endif()
  list(TRANSFORM ARG_FOLDERS REPLACE "(.+)" "${CMAKE_SOURCE_DIR}/\\1/*.cpp")
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${ARG_FOLDERS})
  list(FILTER sources EXCLUDE REGEX "/main_[^/]*\\.cpp$")
  add_library(mote_${name} STATIC)
  mote_sources(mote_${name} ${sources} ALONE ${ARG_ALONE} COMMAND_LINE ${ARG_COMMAND_LINE})
  target_link_libraries(mote_${name} PUBLIC mote_options ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
endfunction()
