# cmake -DSOURCE=<mote's folder> -DOUT=<folder> "-DFOLDERS=core;media;..." -P cmake/package_headers.cmake
#
# Writes the headers of the folders to OUT as others include them: in them "core/math/ray.h" becomes
# "mote/core/math/ray.h", so that OUT's parent is all that a consumer's include path needs and no folder called `core`
# gets into it. Within mote the short form stays. What did not change is not touched; what is gone is removed.

cmake_minimum_required(VERSION 3.22)
string(REPLACE ";" "|" any_folder "${FOLDERS}")
set(headers "")
foreach(folder ${FOLDERS})
  file(GLOB_RECURSE found RELATIVE ${SOURCE} ${SOURCE}/${folder}/*.h)
  list(APPEND headers ${found})
endforeach()
foreach(header ${headers})
  file(READ ${SOURCE}/${header} text)
  string(REGEX REPLACE "#include \"((${any_folder})/[^\"]+)\"" "#include \"mote/\\1\"" text "${text}")
  set(before "")
  if(EXISTS ${OUT}/${header})
    file(READ ${OUT}/${header} before)
  endif()
  if(NOT text STREQUAL before)
    file(WRITE ${OUT}/${header} "${text}")
  endif()
endforeach()

file(GLOB_RECURSE written RELATIVE ${OUT} ${OUT}/*.h)
list(REMOVE_ITEM written ${headers} version.h)
foreach(header ${written})
  file(REMOVE ${OUT}/${header})
endforeach()
