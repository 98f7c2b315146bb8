# A Debian package of what `cmake --install` installs: `cpack -G DEB` in the build folder.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME limn)
set(CPACK_PACKAGE_VENDOR "The limn authors")
set(CPACK_PACKAGE_CONTACT "The limn authors <limn@localhost>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_DIRECTORY ${CMAKE_BINARY_DIR}/package)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION "Real-time shadows and global illumination, with their error and their cost
 A core, techniques as plug-ins, a viewer, and a bench that measures error against
 time beside a path-traced reference.")
# Linked libraries are found; the software renderer is opened at run time.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_LIBRARY_OUTPUT_DIRECTORY})
set(CPACK_DEBIAN_PACKAGE_DEPENDS "libgl1-mesa-dri, fonts-dejavu-core")
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "libosmesa6, bash-completion")
# Modules are built against the installed headers; movies and models of other formats are other programs' work.
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "cmake, make, g++, python3, libglm-dev, libfmt-dev, libegl-dev, ffmpeg, assimp-utils")
include(CPack)
