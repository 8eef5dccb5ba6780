# Run at every build: writes OUTPUT (a header with the commit of SOURCE_DIR) if the commit has changed.
execute_process(
  COMMAND git --no-optional-locks describe --always --abbrev=12 --dirty --exclude=*
  WORKING_DIRECTORY "${SOURCE_DIR}" OUTPUT_VARIABLE hash OUTPUT_STRIP_TRAILING_WHITESPACE
  RESULT_VARIABLE status ERROR_QUIET)
if(NOT status EQUAL 0 OR hash STREQUAL "")
  set(hash unknown)
endif()
file(CONFIGURE OUTPUT "${OUTPUT}" CONTENT "#pragma once\nnamespace lockstep {\nconstexpr const char* git_hash = \"${hash}\";\n}\n" @ONLY)
