# What a user of the installed library does, step by step; any failing step stops with its output.
function(run_step what)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${what} failed (${result}):\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

set(prefix "${WORK_DIR}/prefix")
set(copy "${WORK_DIR}/my-driver")
file(REMOVE_RECURSE "${prefix}" "${copy}")
run_step("Installing" ${CMAKE_COMMAND} --install "${BINARY_DIR}" --prefix "${prefix}")
file(COPY "${prefix}/share/lockstep/template/" DESTINATION "${copy}")
run_step("Configuring the template" ${CMAKE_COMMAND} -S "${copy}" -B "${copy}/build" -G "${GENERATOR}"
         "-DCMAKE_PREFIX_PATH=${prefix}" "-DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}"
         "-DCMAKE_BUILD_TYPE=${BUILD_TYPE}")
run_step("Building the template" ${CMAKE_COMMAND} --build "${copy}/build")

run_step("The template's driver" "${copy}/build/driver")
if(NOT output MATCHES "1 ranks")
  message(FATAL_ERROR "The template's driver wrote '${output}'.")
endif()
run_step("The template's driver on 2 ranks" ${MPIEXEC} -np 2 "${copy}/build/driver")
if(NOT output MATCHES "2 ranks")
  message(FATAL_ERROR "The template's driver wrote '${output}' on 2 ranks.")
endif()

# The headers of the installed tree alone must do: none may point back to the source tree.
file(GLOB_RECURSE installed "${prefix}/lib/*.cmake")
foreach(file IN LISTS installed)
  file(READ "${file}" text)
  if(text MATCHES "${BINARY_DIR}")
    string(REPLACE "${prefix}" "" text "${text}")
    if(text MATCHES "${BINARY_DIR}")
      message(FATAL_ERROR "${file} points back to the build tree.")
    endif()
  endif()
endforeach()
