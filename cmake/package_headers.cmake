# cmake -DSOURCE=<mote's folder> -DOUT=<folder> "-DFOLDERS=core|media|..." -P cmake/package_headers.cmake
#
# Writes the public headers (cmake/public_headers.txt), and all that they include of the folders, to OUT as others
# include them: in them "core/math/ray.h" becomes "mote/core/math/ray.h", so that OUT's parent is all that a consumer's
# include path needs and no folder called `core` gets into it. Within mote the short form stays. What did not change is
# not touched; what is gone is removed.

cmake_minimum_required(VERSION 3.22)
file(STRINGS ${SOURCE}/cmake/public_headers.txt todo REGEX "^[^#]")
set(headers "")
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
  set(before "")
  if(EXISTS ${OUT}/${header})
    file(READ ${OUT}/${header} before)
  endif()
  if(NOT text STREQUAL before)
    file(WRITE ${OUT}/${header} "${text}")
  endif()
endwhile()

file(GLOB_RECURSE written RELATIVE ${OUT} ${OUT}/*.h)
list(REMOVE_ITEM written ${headers} version.h)
foreach(header ${written})
  file(REMOVE ${OUT}/${header})
endforeach()
