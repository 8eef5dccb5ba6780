# Imported targets of all libraries that Lockstep builds on. Used by the build itself and, installed
# beside LockstepConfig.cmake, by out-of-tree projects.
include_guard(GLOBAL)

find_package(MPI REQUIRED COMPONENTS CXX)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(fmt REQUIRED)
find_package(Boost REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(tinyobjloader REQUIRED)
find_package(CLI11 REQUIRED)

set(HDF5_PREFER_PARALLEL ON)
find_package(HDF5 REQUIRED COMPONENTS C)
if(NOT HDF5_IS_PARALLEL)
  message(FATAL_ERROR "Lockstep needs the parallel HDF5 (Debian package libhdf5-openmpi-dev).")
endif()

find_path(METIS_INCLUDE_DIR metis.h REQUIRED)
find_library(METIS_LIBRARY metis REQUIRED)

find_package(Trilinos REQUIRED COMPONENTS
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
