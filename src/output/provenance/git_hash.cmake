# Run at every build: writes OUTPUT (a header with the commit of SOURCE_DIR) if the commit has changed.
execute_process(
  COMMAND git --no-optional-locks describe --always --abbrev=12 --dirty --exclude=*
  WORKING_DIRECTORY "${SOURCE_DIR}" OUTPUT_VARIABLE hash OUTPUT_STRIP_TRAILING_WHITESPACE
  RESULT_VARIABLE status ERROR_QUIET)
if(NOT status EQUAL 0 OR hash STREQUAL "")
  set(hash unknown)
endif()
set(text "#pragma once\nnamespace lockstep {\nconstexpr const char* git_hash = \"${hash}\";\n}\n")
set(old "")
if(EXISTS "${OUTPUT}")
  file(READ "${OUTPUT}" old)
endif()
if(NOT text STREQUAL old)
  file(WRITE "${OUTPUT}" "${text}")
endif()
