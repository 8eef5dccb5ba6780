# Installs what find_package(Lockstep) needs: the exported targets, the search for the libraries
# underneath, the scenes and the template of an out-of-tree project.
include(CMakePackageConfigHelpers)
set(lockstep_cmake_directory "${CMAKE_INSTALL_LIBDIR}/cmake/Lockstep")

configure_package_config_file("${CMAKE_CURRENT_LIST_DIR}/LockstepConfig.cmake.in"
  "${PROJECT_BINARY_DIR}/generated/cmake/LockstepConfig.cmake"
  INSTALL_DESTINATION "${lockstep_cmake_directory}" PATH_VARS CMAKE_INSTALL_DATADIR CMAKE_INSTALL_INCLUDEDIR)
write_basic_package_version_file("${PROJECT_BINARY_DIR}/generated/cmake/LockstepConfigVersion.cmake"
                                 COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/generated/cmake/LockstepConfig.cmake"
              "${PROJECT_BINARY_DIR}/generated/cmake/LockstepConfigVersion.cmake"
              "${CMAKE_CURRENT_LIST_DIR}/LockstepDependencies.cmake"
              "${CMAKE_CURRENT_LIST_DIR}/LockstepPlugIn.cmake"
        DESTINATION "${lockstep_cmake_directory}")
install(EXPORT LockstepTargets NAMESPACE Lockstep:: DESTINATION "${lockstep_cmake_directory}")
install(DIRECTORY "${PROJECT_SOURCE_DIR}/xml-params" "${PROJECT_SOURCE_DIR}/template"
        DESTINATION "${CMAKE_INSTALL_DATADIR}/lockstep")
# What shows runs and studies; the rest of tools/ is for work on the tree itself.
set(tools_folder "${PROJECT_SOURCE_DIR}/tools")
install(PROGRAMS "${tools_folder}/report" "${tools_folder}/watch" "${tools_folder}/render"
                 "${tools_folder}/plot-frame" "${tools_folder}/plot-study" "${tools_folder}/plot-curves"
                 "${tools_folder}/export-meshes" "${tools_folder}/export-volumes" "${tools_folder}/urdf-to-scene"
                 "${tools_folder}/xml-to-yaml"
        DESTINATION "${CMAKE_INSTALL_DATADIR}/lockstep/tools")
install(FILES "${tools_folder}/lockstep_frames.py" "${tools_folder}/plot_style.py" "${tools_folder}/run_parameters.py" "${tools_folder}/robot.py"
              "${tools_folder}/render_with_paraview.py" "${tools_folder}/virtual_screen.py" "${tools_folder}/movies.py"
        DESTINATION "${CMAKE_INSTALL_DATADIR}/lockstep/tools")
install(DIRECTORY "${tools_folder}/report_page" DESTINATION "${CMAKE_INSTALL_DATADIR}/lockstep/tools"
        PATTERN "__pycache__" EXCLUDE)
