# What an out-of-tree technique builds against: liblimn, the headers under include/limn with the same include roots as
# here ("core/...", "glsl/..."), and a package that brings limn::limn, limn::reference,
# limn_add_technique() and limn_embed().
include(CMakePackageConfigHelpers)
set(LIMN_INSTALL_INCLUDE ${CMAKE_INSTALL_INCLUDEDIR}/limn)
set(LIMN_INSTALL_CMAKE ${CMAKE_INSTALL_LIBDIR}/cmake/limn)

install(TARGETS limn limn_reference EXPORT limnTargets LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS limn_bench limn_session LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS limn_read_grid limn_read_draco RUNTIME DESTINATION ${CMAKE_INSTALL_LIBDIR}/limn)
install(TARGETS limn_image_files LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/limn)
install(EXPORT limnTargets NAMESPACE limn:: DESTINATION ${LIMN_INSTALL_CMAKE})

# The headers of module_headers.txt, what these include, and all shared GLSL. Those of an earlier limn go first: the hash that
# modules are accepted by covers all GLSL that is there.
string(JOIN "\" \"" roots ${LIMN_INCLUDE_ROOTS})
install(CODE "
  set(headers \"\${CMAKE_INSTALL_PREFIX}/${LIMN_INSTALL_INCLUDE}\")
  file(REMOVE_RECURSE \"\$ENV{DESTDIR}\${headers}/core\" \"\$ENV{DESTDIR}\${headers}/glsl\")
  execute_process(COMMAND \"${Python3_EXECUTABLE}\" -B \"${CMAKE_CURRENT_SOURCE_DIR}/cmake/module_headers.py\" install
    \"\$ENV{DESTDIR}\${headers}\" \"${roots}\" COMMAND_ERROR_IS_FATAL ANY OUTPUT_VARIABLE names
    OUTPUT_STRIP_TRAILING_WHITESPACE)
  string(REPLACE \"\\n\" \";\" names \"\${names}\")
  list(TRANSFORM names PREPEND \"\${headers}/\")
  list(APPEND CMAKE_INSTALL_MANIFEST_FILES \${names})")

configure_package_config_file(cmake/limnConfig.cmake.in ${CMAKE_BINARY_DIR}/limnConfig.cmake
  INSTALL_DESTINATION ${LIMN_INSTALL_CMAKE} PATH_VARS LIMN_INSTALL_INCLUDE)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/limnConfigVersion.cmake COMPATIBILITY ExactVersion)
install(FILES ${CMAKE_BINARY_DIR}/limnConfig.cmake ${CMAKE_BINARY_DIR}/limnConfigVersion.cmake
  cmake/LimnTechnique.cmake cmake/embed.py cmake/module_headers.py cmake/module_headers.txt DESTINATION ${LIMN_INSTALL_CMAKE})
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright)
