# Writes OUTPUT with the short hash of the commit in SOURCE_DIR, with "+" where files were changed since.
execute_process(COMMAND git describe --always --dirty=+ --abbrev=12 --exclude=*
                WORKING_DIRECTORY ${SOURCE_DIR} OUTPUT_VARIABLE hash OUTPUT_STRIP_TRAILING_WHITESPACE
                RESULT_VARIABLE result ERROR_QUIET)
if(NOT result EQUAL 0 OR hash STREQUAL "")
  set(hash "unknown")
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "#define MOTE_GIT_HASH \"${hash}\"\n")
