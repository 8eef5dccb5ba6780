# Imported targets of all libraries that Lockstep builds on. Used by the build itself and, installed
# beside LockstepConfig.cmake, by out-of-tree projects.
include_guard(DIRECTORY)

# lockstep_require(PACKAGE DEBIAN_PACKAGE arguments of find_package...): stops with the name of the
# Debian package to install.
macro(lockstep_require package debian_package)
  find_package(${package} ${ARGN} QUIET)
  if(NOT ${package}_FOUND)
    message(FATAL_ERROR "Lockstep needs ${package} (${ARGN}), Debian package ${debian_package}. "
                        "On Debian 12, tools/set-up installs all that Lockstep needs.")
  endif()
endmacro()

lockstep_require(MPI libopenmpi-dev COMPONENTS CXX)
lockstep_require(Eigen3 libeigen3-dev 3.4 NO_MODULE)
lockstep_require(fmt libfmt-dev 9)
lockstep_require(Boost libboost-dev 1.74)
lockstep_require(nlohmann_json nlohmann-json3-dev)
lockstep_require(tinyobjloader libtinyobjloader-dev)
lockstep_require(CLI11 libcli11-dev)
lockstep_require(EXPAT libexpat1-dev)
lockstep_require(yaml-cpp libyaml-cpp-dev)
lockstep_require(muparser libmuparser-dev)
lockstep_require(ZLIB zlib1g-dev)
lockstep_require(Threads g++)

set(HDF5_PREFER_PARALLEL ON)
lockstep_require(HDF5 libhdf5-openmpi-dev COMPONENTS C)
if(NOT HDF5_IS_PARALLEL)
  message(FATAL_ERROR "Lockstep needs the parallel HDF5, Debian package libhdf5-openmpi-dev; the one "
                      "found (version ${HDF5_VERSION}, ${HDF5_C_LIBRARIES}) is serial.")
endif()

find_path(METIS_INCLUDE_DIR metis.h)
find_library(METIS_LIBRARY metis)
if(NOT METIS_INCLUDE_DIR OR NOT METIS_LIBRARY)
  message(FATAL_ERROR "Lockstep needs METIS, Debian package libmetis-dev.")
endif()

lockstep_require(Trilinos trilinos-all-dev COMPONENTS
                 Teuchos Tpetra Thyra ThyraTpetraAdapters Belos Stratimikos Teko Ifpack2 Amesos2 MueLu)
# Debian's exported targets name development symlinks (scotch) that no Trilinos package installs:
# strip absolute link items that do not exist.
foreach(target IN LISTS Trilinos_LIBRARIES)
  if(TARGET ${target})
    get_target_property(items ${target} INTERFACE_LINK_LIBRARIES)
    set(kept "")
    foreach(item IN LISTS items)
      if(NOT IS_ABSOLUTE "${item}" OR EXISTS "${item}")
        list(APPEND kept "${item}")
      endif()
    endforeach()
    if(items)
      set_property(TARGET ${target} PROPERTY INTERFACE_LINK_LIBRARIES "${kept}")
    endif()
  endif()
endforeach()

if(NOT TARGET Lockstep::trilinos)
  add_library(Lockstep::trilinos INTERFACE IMPORTED)
  target_include_directories(Lockstep::trilinos SYSTEM INTERFACE
                             ${Trilinos_INCLUDE_DIRS} ${Trilinos_TPL_INCLUDE_DIRS})
  target_link_libraries(Lockstep::trilinos INTERFACE ${Trilinos_LIBRARIES} MPI::MPI_CXX)
  target_link_options(Lockstep::trilinos INTERFACE LINKER:--as-needed)

  add_library(Lockstep::hdf5 INTERFACE IMPORTED)
  target_include_directories(Lockstep::hdf5 SYSTEM INTERFACE ${HDF5_C_INCLUDE_DIRS})
  target_link_libraries(Lockstep::hdf5 INTERFACE ${HDF5_C_LIBRARIES} MPI::MPI_CXX)

  add_library(Lockstep::metis INTERFACE IMPORTED)
  target_include_directories(Lockstep::metis SYSTEM INTERFACE ${METIS_INCLUDE_DIR})
  target_link_libraries(Lockstep::metis INTERFACE ${METIS_LIBRARY})
endif()
