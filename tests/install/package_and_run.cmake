# Packs this build, unpacks the package and uses what is in it: programs, scenes, tools, find_package.
include("${CMAKE_CURRENT_LIST_DIR}/steps.cmake")

file(REMOVE_RECURSE "${WORK_DIR}")
run_step("Packing" cpack --config "${BINARY_DIR}/CPackConfig.cmake" -B "${WORK_DIR}")
file(GLOB package "${WORK_DIR}/lockstep_*.deb")
run_step("Reading the package" dpkg-deb --field "${package}" Depends)
foreach(needed libtrilinos openmpi-bin libhdf5 python3-h5py)
  expect("${needed}")
endforeach()
run_step("Unpacking" dpkg-deb --extract "${package}" "${WORK_DIR}/unpacked")
set(usr "${WORK_DIR}/unpacked/usr")

set(scene "${usr}/share/lockstep/xml-params/scenes/constraints-2d.xml")
run_step("The packed simulate" "${usr}/bin/simulate" "${scene}" --output "${WORK_DIR}/run" --steps 2
         --set "Domain/Cells={24, 24}")
expect("step     2")
run_step("The packed report" "${usr}/share/lockstep/tools/report" "${WORK_DIR}/run")
expect("report.html")
# Each finds the modules that it shares with others.
file(GLOB tools LIST_DIRECTORIES false "${usr}/share/lockstep/tools/*")
list(FILTER tools EXCLUDE REGEX "\\.py$")
foreach(tool IN LISTS tools)
  run_step("The packed ${tool}" "${tool}" --help)
  expect("usage:")
endforeach()
run_step("The packed converge" "${usr}/bin/converge" "${usr}/share/lockstep/xml-params/studies/taylor-green.xml"
         --rungs 1:1 --series "inviscid, cubic" --output "${WORK_DIR}/study" --list)
expect("Domain/Cells")

if(HAS_MODULE)
  run_step("The packed Python module" ${CMAKE_COMMAND} -E env "PYTHONPATH=${usr}/lib/python3/dist-packages"
           "${PYTHON}" "${CMAKE_CURRENT_LIST_DIR}/one_step.py" "${scene}" "${WORK_DIR}/stepped")
  expect("1 step")
endif()

run_step("Configuring the template" ${CMAKE_COMMAND} -S "${usr}/share/lockstep/template"
         -B "${WORK_DIR}/template" -G "${GENERATOR}" "-DCMAKE_PREFIX_PATH=${usr}")
file(STRINGS "${WORK_DIR}/template/CMakeCache.txt" found REGEX "^Lockstep_DIR:")
if(NOT found MATCHES "${usr}/lib")
  message(FATAL_ERROR "The template found Lockstep elsewhere: ${found}")
endif()
