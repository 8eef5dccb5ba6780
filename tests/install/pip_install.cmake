# The Python package by pip, as a wheel and out of it, from this build and without a network.
include("${CMAKE_CURRENT_LIST_DIR}/steps.cmake")

file(REMOVE_RECURSE "${WORK_DIR}")
file(RELATIVE_PATH folder "${SOURCE_DIR}" "${BINARY_DIR}")
set(ENV{LOCKSTEP_BUILD_FOLDER} "${folder}")
run_step("Making the wheel" "${PYTHON}" -m pip wheel --no-build-isolation --no-deps --no-index
         --wheel-dir "${WORK_DIR}" "${SOURCE_DIR}")
file(GLOB wheel "${WORK_DIR}/lockstep-*.whl")
run_step("Installing the wheel" "${PYTHON}" -m pip install --no-deps --no-index --target "${WORK_DIR}/site" "${wheel}")
foreach(file __init__.py run.py py.typed _core.pyi)
  if(NOT EXISTS "${WORK_DIR}/site/lockstep/${file}")
    message(FATAL_ERROR "The wheel has no ${file}.")
  endif()
endforeach()
run_step("The installed package" ${CMAKE_COMMAND} -E env "PYTHONPATH=${WORK_DIR}/site" "${PYTHON}"
         "${CMAKE_CURRENT_LIST_DIR}/one_step.py" "${SOURCE_DIR}/xml-params/scenes/constraints-2d.xml"
         "${WORK_DIR}/stepped")
expect("1 step")
