# The template's plug-ins, in the programs that are installed.
set(library "${copy}/build/libmine.so")
set(simulate "${prefix}/bin/simulate")
set(piston "${copy}/piston.xml")

# As in the driver that has them built in, to the last digit, on two ranks too.
foreach(ranks 1 2)
  run_step("The library on ${ranks} ranks" ${MPIEXEC} -np ${ranks} "${simulate}" --plug-in "${library}" "${piston}"
           --output "${copy}/library-${ranks}")
  foreach(table "bodies" "stroke of the piston")
    expect_same("${copy}/run-${ranks}/${table}.csv" "${copy}/library-${ranks}/${table}.csv")
  endforeach()
endforeach()
run_step("The list of plug-ins" "${simulate}" --plug-in "${library}" --list-plugins)
foreach(line "solid: piston \\(2D\\)" "interface model: given level \\(2D\\)" "solver strategy: steepest-descent" "material: corotated")
  expect("${line}")
endforeach()

# A strategy, by simulate and by solve.
run_step("A system" "${simulate}" --plug-in "${library}" "${piston}" --output "${copy}/dumped" --steps 2
         --set "Solver/Strategy/Type=steepest-descent" --dump-system 2:S2 "${copy}/system.h5")
run_step("The strategy of the library" "${prefix}/bin/solve" "${copy}/system.h5" "${copy}/steepest-descent.xml"
         --plug-in "${library}" --output "${copy}/solved")
expect("steepest-descent +[1-9]")

# A study, with the library and with the driver.
run_step("A study with the library" "${prefix}/bin/converge" "${copy}/piston-study.xml" --plug-in "${library}"
         --output "${copy}/study-library")
run_step("A study of the driver" "${prefix}/bin/converge" "${copy}/piston-study.xml" --simulate "${copy}/build/simulate"
         --output "${copy}/study-driver")
foreach(how library driver)
  file(STRINGS "${copy}/study-${how}/table.csv" rows)
  if(NOT "${rows}" MATCHES "0\\.0545454545")
    message(FATAL_ERROR "The study of the ${how} has: ${rows}")
  endif()
endforeach()

# Sets `result` to the last number of a column of a table.
function(last_value table column result)
  file(STRINGS "${table}" rows)
  list(FILTER rows EXCLUDE REGEX "^#")
  list(GET rows 0 columns)
  list(GET rows -1 row)
  string(REPLACE "," ";" columns "${columns}")
  string(REPLACE "," ";" row "${row}")
  list(FIND columns "${column}" number)
  list(GET row ${number} value)
  set(${result} ${value} PARENT_SCOPE)
endfunction()

# A material, in a project of four lines; its scene names the library. Without fibres it is the law that ships.
set(material "${copy}/material")
run_step("Configuring the material" ${CMAKE_COMMAND} -S "${material}" -B "${material}/build" -G "${GENERATOR}"
         "-DCMAKE_PREFIX_PATH=${prefix}" "-DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}")
run_step("Building the material" ${CMAKE_COMMAND} --build "${material}/build")
file(READ "${material}/fibres.xml" scene)
string(REGEX REPLACE "\n[^\n]*(Plug-ins|Fibre)[^\n]*" "" scene "${scene}")
string(REPLACE "\"fibres\"" "\"st venant-kirchhoff\"" scene "${scene}")
file(WRITE "${copy}/flesh.xml" "${scene}")
run_step("The law that ships" "${simulate}" "${copy}/flesh.xml" --output "${copy}/flesh")
run_step("The material without fibres" "${simulate}" "${material}/fibres.xml" --output "${copy}/no-fibres"
         --set "Solids/Strip/Material/Fibre Stiffness=0")
run_step("The material" "${simulate}" "${material}/fibres.xml" --output "${copy}/fibres")
expect_same("${copy}/flesh/bodies.csv" "${copy}/no-fibres/bodies.csv")
last_value("${copy}/flesh/bodies.csv" "y" soft_height)
last_value("${copy}/fibres/bodies.csv" "y" stiff_height)
# Its middle sinks by (rho - 1000) g L^2 / (3 E'), E' = E/(1 - nu^2) plus the fibres: 24 and 2.2 mm at rest, here still swinging.
if(NOT soft_height LESS 0.588 OR NOT stiff_height GREATER 0.5956)
  message(FATAL_ERROR "The strip hangs at ${soft_height} m, with fibres at ${stiff_height} m.")
endif()

# A coupling that derives from one that ships, a contact model, a joint with a target, and a material with a memory, each a project
# of four lines.
foreach(project coupling contact joint viscoelastic)
  set(folder "${copy}/${project}")
  run_step("Configuring the ${project}" ${CMAKE_COMMAND} -S "${folder}" -B "${folder}/build" -G "${GENERATOR}"
           "-DCMAKE_PREFIX_PATH=${prefix}" "-DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}")
  run_step("Building the ${project}" ${CMAKE_COMMAND} --build "${folder}/build")
endforeach()
run_step("The coupling" "${simulate}" "${copy}/coupling/plate.yaml" --output "${copy}/plate")
last_value("${copy}/plate/bodies.csv" "vx" speed)
if(NOT speed GREATER 0.003333 OR NOT speed LESS 0.003334)  # F dt / m, 10 N/m * .01 s / 30 kg/m
  message(FATAL_ERROR "The plate that the fluid does not see along x has ${speed} m/s.")
endif()
run_step("The contact model" "${simulate}" "${copy}/contact/disc.yaml" --output "${copy}/disc")
last_value("${copy}/disc/bodies.csv" "y" height)
last_value("${copy}/disc/bodies.csv" "contact_fy" push)
# Its mesh is a polygon. It weighs pi R^2 g rho less a thousandth of buoyancy.
if(NOT height GREATER 0.2995 OR NOT height LESS 0.3005 OR NOT push GREATER 307 OR NOT push LESS 308.5)
  message(FATAL_ERROR "The disc lies at ${height} m, and the floor pushes it by ${push} N/m.")
endif()


# A nut on a screw, an arm that a target leads, in one go on two ranks and in halves.
set(screw "${copy}/joint/lead-screw.yaml")
foreach(ranks 1 2)
  run_step("The joint on ${ranks} ranks" ${MPIEXEC} -np ${ranks} "${simulate}" "${screw}" --output "${copy}/screw-${ranks}")
  last_value("${copy}/screw-${ranks}/bodies.csv" "z" height)
  last_value("${copy}/screw-${ranks}/joints.csv" "q" angle)
  # z = 0.7 - a t^2/2, a = g / (1 + I/(m p^2)), I/m = 0.2^2/6, p = 0.1/(2 pi); the arm has turned by pi/2.
  if(NOT height MATCHES "^0\\.5204542" OR NOT angle MATCHES "^1\\.5707963")
    message(FATAL_ERROR "The nut is at ${height} m, the arm at ${angle} rad on ${ranks} ranks.")
  endif()
endforeach()
run_step("Half of the joint's scene" "${simulate}" "${screw}" --output "${copy}/screw-halves" --set "Time/Steps=50")
run_step("The other half" "${simulate}" "${screw}" --output "${copy}/screw-halves"
         --restart "${copy}/screw-halves/checkpoint-000050.h5")
foreach(table bodies joints)
  expect_same("${copy}/screw-1/${table}.csv" "${copy}/screw-halves/${table}.csv")
endforeach()
run_step("The list of joints" "${simulate}" --plug-in "${copy}/joint/build/libscrew.so" --list-plugins)
foreach(line "joint: screw" "joint: hinge" "target: smooth step" "may add to each kind of: .*joint, target")
  expect("${line}")
endforeach()
refuse_step(2 "is \"scrw\".*did you mean \"screw\"" "${simulate}" "${screw}" --set "Joints/Screw/Type=scrw")
refuse_step(2 "\"Led\".*Did you mean \"Lead\"" "${simulate}" "${screw}" --set "Joints/Screw/Led=0.1")
refuse_step(2 "is \"smooth stop\".*did you mean \"smooth step\"" "${simulate}" "${screw}" --set "Joints/Shoulder/Target/Type=smooth stop")

# A held strip whose stress relaxes: A E_xx^2 (mu + lambda/2) = 20.3606 J stay, three times as much fall as exp(-2 t/0.5 s).
set(strip "${copy}/viscoelastic/strip.yaml")
foreach(ranks 1 2)
  run_step("The material with a memory on ${ranks} ranks" ${MPIEXEC} -np ${ranks} "${simulate}" "${strip}" --output "${copy}/strip-${ranks}")
  last_value("${copy}/strip-${ranks}/history.csv" "elastic_energy" energy)
  if(NOT energy MATCHES "^32\\.69276")
    message(FATAL_ERROR "The strip has ${energy} J on ${ranks} ranks.")
  endif()
endforeach()
run_step("Half of the strip's scene" "${simulate}" "${strip}" --output "${copy}/strip-halves" --set "Time/Steps=10")
run_step("The other half" "${simulate}" "${strip}" --output "${copy}/strip-halves" --restart "${copy}/strip-halves/checkpoint-000010.h5")
expect_same("${copy}/strip-1/bodies.csv" "${copy}/strip-halves/bodies.csv")
last_value("${copy}/strip-halves/history.csv" "elastic_energy" energy_of_halves)
last_value("${copy}/strip-1/history.csv" "elastic_energy" energy)
if(NOT energy STREQUAL energy_of_halves)
  message(FATAL_ERROR "The strip has ${energy_of_halves} J after a restart, ${energy} J without.")
endif()
refuse_step(2 "\"Relaxation Times\".*Did you mean \"Relaxation Time\"" "${simulate}" "${strip}" --set "Solids/Strip/Material/Relaxation Times=1")

if(HAS_MODULE)
  run_step("Python" ${CMAKE_COMMAND} -E env "PYTHONPATH=${prefix}/lib/python3/dist-packages" "${PYTHON}"
           "${CMAKE_CURRENT_LIST_DIR}/one_step.py" "${piston}" "${copy}/stepped" "${library}")
  expect("1 step")
  run_step("Python, of a scene that names a library" ${CMAKE_COMMAND} -E env
           "PYTHONPATH=${prefix}/lib/python3/dist-packages" "${PYTHON}"
           "${CMAKE_CURRENT_LIST_DIR}/one_step.py" "${material}/fibres.xml" "${copy}/stepped-fibres")
  expect("1 step")
  run_step("Python, with the joint" ${CMAKE_COMMAND} -E env "PYTHONPATH=${prefix}/lib/python3/dist-packages" "${PYTHON}"
           "${CMAKE_CURRENT_LIST_DIR}/one_step.py" "${screw}" "${copy}/stepped-screw")
  expect("1 step")
endif()

# Libraries that cannot be loaded, in one sentence each.
function(bad_library name text)
  file(WRITE "${copy}/${name}.c" "${text}")
  run_step("Compiling ${name}" "${C_COMPILER}" -shared -fPIC -o "${copy}/${name}.so" "${copy}/${name}.c")
endfunction()
set(build "const struct { const char *headers, *compiler; int alignment; } lockstep_plug_in_build = ")
bad_library(nothing "int nothing;")
bad_library(other-version "${build}{\"0.0.9, headers 0\", \"1.0\", 16};")
bad_library(unresolved "void missing_function(void); void (*pointer)(void) = missing_function;")
file(COPY_FILE "${library}" "${copy}/twice.so")
refuse_step(2 "There is no plug-in '[^']*none.so'" "${simulate}" --plug-in none.so "${piston}")
refuse_step(2 "is a folder" "${simulate}" --plug-in "${copy}" "${piston}")
refuse_step(2 "piston.xml' cannot be loaded: .*invalid ELF header" "${simulate}" --plug-in "${piston}" "${piston}")
refuse_step(2 "is no library of plug-ins" "${simulate}" --plug-in "${copy}/nothing.so" "${piston}")
refuse_step(2 "was built for Lockstep 0.0.9, headers 0, compiler 1.0" "${simulate}" --plug-in "${copy}/other-version.so" "${piston}")
refuse_step(2 "this program has no missing_function" "${simulate}" --plug-in "${copy}/unresolved.so" "${piston}")
refuse_step(2 "twice.so' cannot be registered: The fluid \"column\" is registered twice" "${simulate}"
            --plug-in "${library}" --plug-in "${copy}/twice.so" "${piston}")
refuse_step(2 "There is no plug-in '[^']*none.so'" "${prefix}/bin/solve" "${copy}/system.h5" "${copy}/steepest-descent.xml" --plug-in none.so)
refuse_step(2 "Cannot read the plug-in '[^']*none.so'" "${prefix}/bin/converge" "${copy}/piston-study.xml" --plug-in none.so
            --output "${copy}/study-none")
