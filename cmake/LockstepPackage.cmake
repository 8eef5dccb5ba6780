# A Debian package of the installed tree: cpack in a build folder, or tools/make-package.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME lockstep)
set(CPACK_PACKAGE_VENDOR "the Lockstep authors")
set(CPACK_PACKAGE_CONTACT "the Lockstep authors <lockstep@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_RESOURCE_FILE_LICENSE "${PROJECT_SOURCE_DIR}/LICENSE")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE gzip)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# To run on several ranks, and for the scripts of share/lockstep/tools.
set(CPACK_DEBIAN_PACKAGE_DEPENDS
    "openmpi-bin, python3, python3-h5py, python3-numpy, python3-scipy, python3-matplotlib, libjs-three")
# For projects that say find_package(Lockstep).
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS
    "cmake, g++, trilinos-all-dev, libptscotch-dev, libopenmpi-dev, libhdf5-openmpi-dev, zlib1g-dev, libeigen3-dev, libmetis-dev, libboost-dev, libexpat1-dev, libyaml-cpp-dev, libtinyobjloader-dev, nlohmann-json3-dev, libfmt-dev, libcli11-dev, libmuparser-dev")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "paraview, python3-meshio, ffmpeg")
include(CPack)
