# Helpers that give every room of the house the same flags, include path and export set.
include_guard(GLOBAL)
include(GNUInstallDirs)

# Flags that change the memory layout of Eigen types must be the same in every project that links
# Lockstep, so they are public.
add_library(lockstep_flags INTERFACE)
target_include_directories(lockstep_flags INTERFACE
  "$<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src>"
  "$<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/packages>"
  "$<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/generated>"
  "$<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/lockstep>")
target_compile_features(lockstep_flags INTERFACE cxx_std_17)
if(LOCKSTEP_NATIVE)
  target_compile_options(lockstep_flags INTERFACE -march=native)
  # What -march=native stands for here, on the command line so that ccache never hands out an object
  # that was compiled for another processor.
  execute_process(COMMAND ${CMAKE_CXX_COMPILER} -march=native -Q --help=target
                  OUTPUT_VARIABLE native_target ERROR_QUIET)
  string(MD5 native_target "${native_target}")
  string(SUBSTRING "${native_target}" 0 8 native_target)
  target_compile_definitions(lockstep_flags INTERFACE
                             "$<BUILD_INTERFACE:LOCKSTEP_PROCESSOR=processor_${native_target}>")
endif()
if(LOCKSTEP_SANITIZE)
  target_compile_options(lockstep_flags INTERFACE -fsanitize=address,undefined
                         -fno-omit-frame-pointer -fno-sanitize-recover=undefined)
  target_link_options(lockstep_flags INTERFACE -fsanitize=address,undefined)
else()
  # Nobody looks at errno or at the processor's flags of exceptions, or replaces a function when a
  # library is loaded: nothing changes but round-off, NaN and infinity keep their meaning.
  target_compile_options(lockstep_flags INTERFACE
    $<$<CXX_COMPILER_ID:GNU,Clang>:-fno-math-errno -fno-trapping-math -fno-semantic-interposition>)
endif()
set(LOCKSTEP_WARNINGS -Wall -Wextra -Wnon-virtual-dtor -Woverloaded-virtual -Werror)
if(LOCKSTEP_UNITY)
  # Files that are compiled at once are told nothing of one another's names: a local variable may be
  # called like a helper of its neighbour, and classes with members from an unnamed namespace are
  # in files, not in headers. Without LOCKSTEP_UNITY these warnings see what is meant.
  list(APPEND LOCKSTEP_WARNINGS -Wshadow=local -Wno-subobject-linkage)
else()
  list(APPEND LOCKSTEP_WARNINGS -Wshadow)
endif()
# GCC 12 takes its own AVX-512 intrinsics, which Eigen's products use, for mistakes of ours; in which
# files depends on the processor. It also sees uninitialized values in what the sanitizers insert.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  list(APPEND LOCKSTEP_WARNINGS -Wno-uninitialized -Wno-maybe-uninitialized -Wno-array-bounds
       -Wno-stringop-overread)
endif()
# Open MPI's C++ classes, which nothing here uses, would be compiled into every object.
target_compile_definitions(lockstep_flags INTERFACE "$<BUILD_INTERFACE:OMPI_SKIP_MPICXX>")
# Rather memory than time: the compiler looks for what it can forget when it holds a gigabyte.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  add_compile_options(--param=ggc-min-heapsize=1000000)
endif()
install(TARGETS lockstep_flags EXPORT LockstepTargets)
add_library(Lockstep::lockstep_flags ALIAS lockstep_flags)

# One precompiled header for all that includes Tpetra, whose headers are half of what such a file takes
# to compile. Headers of other projects only: a change of ours must not compile everything anew.
# Whoever uses it is compiled with -fPIC, as the header is.
add_library(lockstep_precompiled STATIC "${PROJECT_SOURCE_DIR}/cmake/precompiled.cpp")
target_link_libraries(lockstep_precompiled PRIVATE lockstep_flags Eigen3::Eigen fmt::fmt Lockstep::trilinos)
set_target_properties(lockstep_precompiled PROPERTIES POSITION_INDEPENDENT_CODE ON)
if(LOCKSTEP_PRECOMPILED)
  target_precompile_headers(lockstep_precompiled PRIVATE
    <algorithm> <array> <cmath> <cstdint> <filesystem> <fstream> <functional> <limits> <map> <memory>
    <numeric> <optional> <set> <sstream> <string> <utility> <vector>
    <Eigen/Dense> <fmt/format.h> <Teuchos_ParameterList.hpp> <Thyra_VectorSpaceBase.hpp>
    <Tpetra_CrsMatrix.hpp> <Tpetra_Import.hpp> <Tpetra_MultiVector.hpp> <Tpetra_Vector.hpp>)
endif()
function(lockstep_precompile target)
  get_target_property(type ${target} TYPE)
  if(LOCKSTEP_PRECOMPILED)
    set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON)
    if(type STREQUAL "EXECUTABLE")
      target_compile_options(${target} PRIVATE -fPIC)
    endif()
    target_precompile_headers(${target} REUSE_FROM lockstep_precompiled)
  endif()
endfunction()

# Two thirds of what a typical file takes to compile are headers, which its neighbours parse, too.
set(LOCKSTEP_UNITY_FILES 8 CACHE STRING "Files that are compiled at once with LOCKSTEP_UNITY")
function(lockstep_unity target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${LOCKSTEP_UNITY}
                        UNITY_BUILD_BATCH_SIZE ${LOCKSTEP_UNITY_FILES})
endfunction()

# lockstep_library(NAME SOURCES a.cpp... DEPENDS targets...): one static library per room. Headers
# (*.hpp beside the CMakeLists.txt) are installed under include/lockstep/ROOM.
function(lockstep_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS" ${ARGN})
  set(target lockstep_${name})
  if(ARG_SOURCES)
    add_library(${target} STATIC ${ARG_SOURCES})
    target_link_libraries(${target} PUBLIC lockstep_flags ${ARG_DEPENDS})
    target_compile_options(${target} PRIVATE ${LOCKSTEP_WARNINGS})
    set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON)
    lockstep_precompile(${target})
    lockstep_unity(${target})
  else()
    add_library(${target} INTERFACE)
    target_link_libraries(${target} INTERFACE lockstep_flags ${ARG_DEPENDS})
  endif()
  add_library(Lockstep::${target} ALIAS ${target})
  set_property(GLOBAL APPEND PROPERTY LOCKSTEP_LIBRARIES ${target})
  install(TARGETS ${target} EXPORT LockstepTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  get_filename_component(room "${CMAKE_CURRENT_SOURCE_DIR}" NAME)
  install(DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}/" DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/lockstep/${room}
          FILES_MATCHING PATTERN "*.hpp")
endfunction()

# lockstep_all_libraries(): the target lockstep_all, which links every room registered so far.
function(lockstep_all_libraries)
  get_property(libraries GLOBAL PROPERTY LOCKSTEP_LIBRARIES)
  add_library(lockstep_all INTERFACE)
  target_link_libraries(lockstep_all INTERFACE ${libraries})
  add_library(Lockstep::lockstep_all ALIAS lockstep_all)
  install(TARGETS lockstep_all EXPORT LockstepTargets)
  add_custom_target(lockstep_installed)
  foreach(library IN LISTS libraries)
    add_dependencies(lockstep_installed ${library})
  endforeach()
endfunction()

# lockstep_driver(NAME DEPENDS targets...): drivers/NAME.cpp -> executable NAME, which links no more rooms than it needs.
# The target lockstep_drivers builds all; lockstep_installed also what else cmake --install copies.
add_custom_target(lockstep_drivers)
function(lockstep_driver name)
  cmake_parse_arguments(ARG "" "" "DEPENDS" ${ARGN})
  add_executable(${name} ${name}.cpp)
  target_link_libraries(${name} PRIVATE ${ARG_DEPENDS})
  target_compile_options(${name} PRIVATE ${LOCKSTEP_WARNINGS})
  lockstep_precompile(${name})
  add_dependencies(lockstep_drivers ${name})
  add_dependencies(lockstep_installed ${name})
  install(TARGETS ${name} DESTINATION ${CMAKE_INSTALL_BINDIR})
endfunction()

# Open MPI refuses root, and more ranks than cores, unless told; a look at all networks takes longer
# than many a test.
set(LOCKSTEP_TEST_ENVIRONMENT OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
    OMPI_MCA_rmaps_base_oversubscribe=1 OMPI_MCA_pml=ob1 OMP_NUM_THREADS=1)

# lockstep_test(NAME SOURCES ... DEPENDS ... [RANKS 1 2 4] [LABELS ...] [TIMEOUT s]): a googletest
# executable with the MPI-aware main of tests/support, run once per rank count.
function(lockstep_test name)
  cmake_parse_arguments(ARG "" "TIMEOUT" "SOURCES;DEPENDS;RANKS;LABELS" ${ARGN})
  if(NOT ARG_RANKS)
    set(ARG_RANKS 1)
  endif()
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 300)
  endif()
  if(LOCKSTEP_SANITIZE)
    math(EXPR ARG_TIMEOUT "4 * ${ARG_TIMEOUT}")
  endif()
  add_executable(test_${name} ${ARG_SOURCES})
  target_link_libraries(test_${name} PRIVATE lockstep_test_main ${ARG_DEPENDS})
  target_compile_options(test_${name} PRIVATE ${LOCKSTEP_WARNINGS})
  # GCC 12 takes Eigen's reductions of short vectors, on some processors, for loops beyond an end.
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    target_compile_options(test_${name} PRIVATE -Wno-aggressive-loop-optimizations)
  endif()
  lockstep_precompile(test_${name})
  lockstep_unity(test_${name})
  foreach(ranks IN LISTS ARG_RANKS)
    if(ranks EQUAL 1)
      add_test(NAME ${name} COMMAND test_${name})
      set(test ${name})
    else()
      set(test ${name}.mpirun=${ranks})
      add_test(NAME ${test} COMMAND ${MPIEXEC_EXECUTABLE} --oversubscribe -np ${ranks}
                                    $<TARGET_FILE:test_${name}>)
    endif()
    set_tests_properties(${test} PROPERTIES
      LABELS "${ARG_LABELS}" PROCESSORS ${ranks} TIMEOUT ${ARG_TIMEOUT}
      ENVIRONMENT "${LOCKSTEP_TEST_ENVIRONMENT}")
  endforeach()
endfunction()
