# lockstep_add_plug_in(NAME a.cpp...): a library libNAME.so of plug-ins, for --plug-in and "Plug-ins" of scenes. It has no copy
# of Lockstep in it: what it calls is in the program that loads it.
function(lockstep_add_plug_in name)
  add_library(${name} MODULE ${ARGN} "${Lockstep_INCLUDE_DIR}/programs/plug_in_build.cpp")
  target_link_libraries(${name} PRIVATE Lockstep::lockstep_flags Eigen3::Eigen fmt::fmt Lockstep::trilinos Lockstep::hdf5
                                        nlohmann_json::nlohmann_json)
  target_compile_definitions(${name} PRIVATE OMPI_SKIP_MPICXX)
  set_target_properties(${name} PROPERTIES CXX_EXTENSIONS OFF)
  if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
    target_compile_options(${name} PRIVATE -O3 -DNDEBUG)
  endif()
endfunction()
