# Steps of a user, and what each of them must say; a step that fails stops with its output.
function(run_step what)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    message("${output}")
    message(FATAL_ERROR "${what} failed (${result}), see above.")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

# A step that must fail with this exit code, and say this.
function(refuse_step exit_code pattern)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL exit_code OR NOT output MATCHES "${pattern}")
    message(FATAL_ERROR "Instead of ${exit_code} and '${pattern}' there was ${result} with: ${output}")
  endif()
endfunction()

# Two tables that must be equal to the last digit.
function(expect_same one other)
  file(STRINGS "${one}" rows)
  file(STRINGS "${other}" others)
  if(NOT rows STREQUAL others)
    message(FATAL_ERROR "${one} and ${other} differ.")
  endif()
endfunction()

function(expect pattern)
  if(NOT output MATCHES "${pattern}")
    message(FATAL_ERROR "There is no '${pattern}' in: ${output}")
  endif()
endfunction()
