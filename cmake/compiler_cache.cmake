# ccache, where it is installed. It hands files with a precompiled header straight to the compiler unless it is told
# that __TIME__ and the like (which nobody here uses) and macros that are defined before that header (there are none)
# may be passed over. Then it compares the precompiled header byte by byte, as any other.
find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
  execute_process(COMMAND ${CCACHE_PROGRAM} --get-config sloppiness OUTPUT_VARIABLE sloppiness
                  OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(MOTE_PCH AND NOT sloppiness MATCHES "pch_defines.*time_macros")
    set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env
        "CCACHE_SLOPPINESS=${sloppiness},pch_defines,time_macros" ${CCACHE_PROGRAM})
  endif()
endif()
