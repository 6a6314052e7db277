# Run at each build (cmake -P): writes OUTPUT with the version and the state of the sources, if it changed.
#   -DSOURCE=… -DOUTPUT=… -DVERSION=…
set(git "unknown")
find_program(GIT_EXECUTABLE git)
if(GIT_EXECUTABLE AND EXISTS ${SOURCE}/.git)
  execute_process(COMMAND ${GIT_EXECUTABLE} describe --tags --always --dirty --abbrev=12 WORKING_DIRECTORY ${SOURCE}
    OUTPUT_VARIABLE description OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
  if(NOT failed)
    set(git ${description})
  endif()
endif()
file(CONFIGURE OUTPUT ${OUTPUT} @ONLY CONTENT [[
#pragma once
#define CILIAVAL_VERSION "@VERSION@"
#define CILIAVAL_GIT "@git@"
]])
