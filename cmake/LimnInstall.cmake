# What an out-of-tree technique builds against: liblimn, the headers under include/limn with the same include roots as
# here ("core/...", "glsl/..."), and a package that brings limn::limn, limn_add_technique() and limn_embed().
include(CMakePackageConfigHelpers)
set(LIMN_INSTALL_INCLUDE ${CMAKE_INSTALL_INCLUDEDIR}/limn)
set(LIMN_INSTALL_CMAKE ${CMAKE_INSTALL_LIBDIR}/cmake/limn)

install(TARGETS limn EXPORT limnTargets LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS limn_read_grid RUNTIME DESTINATION ${CMAKE_INSTALL_LIBDIR}/limn)
install(EXPORT limnTargets NAMESPACE limn:: DESTINATION ${LIMN_INSTALL_CMAKE})

install(DIRECTORY core DESTINATION ${LIMN_INSTALL_INCLUDE} FILES_MATCHING PATTERN "*.h")
install(DIRECTORY glsl DESTINATION ${LIMN_INSTALL_INCLUDE} FILES_MATCHING PATTERN "*.glsl")
install(FILES ${LIMN_GENERATED_HEADERS} DESTINATION ${LIMN_INSTALL_INCLUDE}/core/context)

configure_package_config_file(cmake/limnConfig.cmake.in ${CMAKE_BINARY_DIR}/limnConfig.cmake
  INSTALL_DESTINATION ${LIMN_INSTALL_CMAKE} PATH_VARS LIMN_INSTALL_INCLUDE)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/limnConfigVersion.cmake COMPATIBILITY ExactVersion)
install(FILES ${CMAKE_BINARY_DIR}/limnConfig.cmake ${CMAKE_BINARY_DIR}/limnConfigVersion.cmake
  cmake/LimnTechnique.cmake cmake/embed.py cmake/interface_hash.py DESTINATION ${LIMN_INSTALL_CMAKE})
