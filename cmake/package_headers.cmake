# cmake -DSOURCE=<mote's folder> -DOUT=<folder> "-DFOLDERS=core|media|..." -DVERSION=<mote's> -P cmake/package_headers.cmake
#
# Writes the public headers (cmake/public_headers.txt), and all that they include of the folders, to OUT as others
# include them: in them "core/math/ray.h" becomes "mote/core/math/ray.h", so that OUT's parent is all that a consumer's
# include path needs and no folder called `core` gets into it. Within mote the short form stays. What did not change is
# not touched; what is gone is removed. interface.h holds a checksum of them all, by which plugins are told apart
# (core/objects/plugin.h).

cmake_minimum_required(VERSION 3.22)
file(STRINGS ${SOURCE}/cmake/public_headers.txt todo REGEX "^[^#]")
set(headers "")
set(interface "")
while(todo)
  list(POP_FRONT todo header)
  if(header IN_LIST headers)
    continue()
  endif()
  if(NOT header MATCHES "^(${FOLDERS})/" OR NOT EXISTS ${SOURCE}/${header})
    message(FATAL_ERROR "cmake/public_headers.txt: ${header} is no header of the package, or one includes it")
  endif()
  list(APPEND headers ${header})
  file(READ ${SOURCE}/${header} text)
  string(REGEX MATCHALL "#include \"[^\"]+\"" included "${text}")
  list(TRANSFORM included REPLACE "#include \"([^\"]+)\"" "\\1")
  list(APPEND todo ${included})
  string(REGEX REPLACE "#include \"((${FOLDERS})/[^\"]+)\"" "#include \"mote/\\1\"" text "${text}")
  string(SHA256 of_header "${text}")
  string(APPEND interface "${header} ${of_header}\n")
  set(before "")
  if(EXISTS ${OUT}/${header})
    file(READ ${OUT}/${header} before)
  endif()
  if(NOT text STREQUAL before)
    file(WRITE ${OUT}/${header} "${text}")
  endif()
endwhile()

string(SHA256 interface "${interface}")
string(SUBSTRING ${interface} 0 12 interface)
set(text "// What a plugin and mote must agree in: the version, and a checksum of the installed headers.
#pragma once

#define MOTE_INTERFACE \"mote ${VERSION}, interface ${interface}\"
")
set(before "")
if(EXISTS ${OUT}/interface.h)
  file(READ ${OUT}/interface.h before)
endif()
if(NOT text STREQUAL before)
  file(WRITE ${OUT}/interface.h "${text}")
endif()

file(GLOB_RECURSE written RELATIVE ${OUT} ${OUT}/*.h)
list(REMOVE_ITEM written ${headers} version.h interface.h)
foreach(header ${written})
  file(REMOVE ${OUT}/${header})
endforeach()
