# Steps of a user of the installed library.
include("${CMAKE_CURRENT_LIST_DIR}/steps.cmake")

set(prefix "${WORK_DIR}/prefix")
set(copy "${WORK_DIR}/my-driver")
file(REMOVE_RECURSE "${prefix}" "${copy}")
run_step("Installing" ${CMAKE_COMMAND} --install "${BINARY_DIR}" --prefix "${prefix}")
file(COPY "${prefix}/share/lockstep/template/" DESTINATION "${copy}")
run_step("Configuring the template" ${CMAKE_COMMAND} -S "${copy}" -B "${copy}/build" -G "${GENERATOR}"
         "-DCMAKE_PREFIX_PATH=${prefix}" "-DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}"
         "-DCMAKE_BUILD_TYPE=${BUILD_TYPE}")
run_step("Building the template" ${CMAKE_COMMAND} --build "${copy}/build")

foreach(ranks 1 2)
  run_step("The template's conformance on ${ranks} ranks" ${MPIEXEC} -np ${ranks}
           "${copy}/build/conformance")
endforeach()
run_step("The template's driver" "${copy}/build/driver" "${copy}/minres-teko.xml")
expect("1 ranks")
run_step("The template's driver on 2 ranks" ${MPIEXEC} -np 2 "${copy}/build/driver"
         "${copy}/minres-teko.xml")
expect("2 ranks")

# Ten steps of 0.4 s of a scene with the same plug-ins: v = t F / (m + rho A L) = 4 * 50 / 1100 m/s.
foreach(ranks 1 2)
  run_step("The template's scene on ${ranks} ranks" ${MPIEXEC} -np ${ranks} "${copy}/build/simulate"
           "${copy}/piston.xml" --output "${copy}/run-${ranks}")
  file(STRINGS "${copy}/run-${ranks}/bodies.csv" rows)
  list(GET rows -1 last)
  if(NOT last MATCHES "0\\.181818181")
    message(FATAL_ERROR "The piston of the template ended with '${last}' on ${ranks} ranks.")
  endif()
  # The observer: x = a t^2 / 2 = 8 a with a = 50/1100, which the half-step velocities have exactly.
  file(STRINGS "${copy}/run-${ranks}/stroke of the piston.csv" rows)
  list(GET rows -1 last)
  if(NOT last MATCHES ",0\\.3636363")
    message(FATAL_ERROR "The observer of the template ended with '${last}' on ${ranks} ranks.")
  endif()
endforeach()

# Half of it, and the rest from the checkpoint: as in one go, to the last digit.
run_step("Half of the template's scene" "${copy}/build/simulate" "${copy}/piston.xml"
         --output "${copy}/run-halves" --set "Time/Steps=5")
run_step("The other half" "${copy}/build/simulate" "${copy}/piston.xml" --output "${copy}/run-halves"
         --restart "${copy}/run-halves/checkpoint-000005.h5" --set "Time/End=4")
foreach(table "bodies" "stroke of the piston")
  expect_same("${copy}/run-1/${table}.csv" "${copy}/run-halves/${table}.csv")
endforeach()

# A tank three eighths full, whose surface the template's interface model gives.
run_step("The template's level" "${copy}/build/simulate" "${copy}/level.xml" --output "${copy}/run-level")
file(STRINGS "${copy}/run-level/history.csv" rows)
list(GET rows -1 last)
if(NOT last MATCHES ",0\\.375,")
  message(FATAL_ERROR "The tank of the template ended with '${last}'.")
endif()

include("${CMAKE_CURRENT_LIST_DIR}/plug_ins.cmake")

# Nothing installed may point back to the trees it came from; the prefix itself lies in the build tree.
file(GLOB_RECURSE installed "${prefix}/lib/*.cmake")
foreach(file IN LISTS installed)
  file(READ "${file}" text)
  string(REPLACE "${prefix}" "" text "${text}")
  string(FIND "${text}" "${BINARY_DIR}" in_binary)
  string(FIND "${text}" "${SOURCE_DIR}/src" in_source)
  if(NOT in_binary EQUAL -1 OR NOT in_source EQUAL -1)
    message(FATAL_ERROR "${file} points back to the source or the build tree.")
  endif()
endforeach()
