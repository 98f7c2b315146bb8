# limn_embed(TARGET FUNCTION ROOT FILES...): compiles text files into TARGET behind `FUNCTION()`.
# limn_interface_hash(TARGET FUNCTION): compiles a hash of limn's interface as it is now (module_headers.py) into TARGET, likewise.
# limn_add_technique(NAME [FOLDER]): builds the *.cpp and *.glsl of FOLDER (default: the current one) to lib/limn/techniques,
# as Release where no build type is chosen.
# Where the folder has a technique.cmake, it is included afterwards: it may link technique_NAME to further libraries.
# All are installed, so that an out-of-tree technique is built by the same call.
#
# LIMN_INCLUDE_ROOTS are the folders that "core/..." and "glsl/..." are looked up in: limn's source tree and what it
# generates, or the installed headers. LIMN_INSTALL_LIBDIR is the folder of liblimn in the prefix.

set(LIMN_EMBED_SCRIPT ${CMAKE_CURRENT_LIST_DIR}/embed.py)
set(LIMN_MODULE_HEADERS_SCRIPT ${CMAKE_CURRENT_LIST_DIR}/module_headers.py)
# Whatever of these changes, the hash of the interface may (it covers what module_headers.txt lists, and what that includes).
list(GET LIMN_INCLUDE_ROOTS 0 LIMN_INTERFACE_HEADERS)
file(GLOB_RECURSE LIMN_INTERFACE_HEADERS CONFIGURE_DEPENDS
  ${LIMN_INTERFACE_HEADERS}/core/*.h ${LIMN_INTERFACE_HEADERS}/glsl/*.glsl)
list(APPEND LIMN_INTERFACE_HEADERS ${LIMN_GENERATED_HEADERS} ${CMAKE_CURRENT_LIST_DIR}/module_headers.txt)
if(NOT Python3_EXECUTABLE)
  find_package(Python3 REQUIRED COMPONENTS Interpreter)
endif()

function(limn_embed target function root)
  string(REPLACE "::" "_" file ${function})
  set(out ${CMAKE_CURRENT_BINARY_DIR}/${file}.cpp)
  add_custom_command(OUTPUT ${out}
    COMMAND ${Python3_EXECUTABLE} ${LIMN_EMBED_SCRIPT} ${out} ${function} ${root} ${ARGN}
    DEPENDS ${LIMN_EMBED_SCRIPT} ${ARGN} VERBATIM)
  target_sources(${target} PRIVATE ${out})
endfunction()

function(limn_interface_hash target function)
  set(out ${CMAKE_CURRENT_BINARY_DIR}/${target}_interface_hash.cpp)
  add_custom_command(OUTPUT ${out}
    COMMAND ${Python3_EXECUTABLE} -B ${LIMN_MODULE_HEADERS_SCRIPT} hash ${out} ${function} ${LIMN_INCLUDE_ROOTS}
    DEPENDS ${LIMN_MODULE_HEADERS_SCRIPT} ${LIMN_INTERFACE_HEADERS} VERBATIM)
  target_sources(${target} PRIVATE ${out})
endfunction()

function(limn_add_technique name)
  set(folder ${CMAKE_CURRENT_SOURCE_DIR})
  if(ARGC GREATER 1)
    get_filename_component(folder ${ARGV1} ABSOLUTE)
  endif()
  file(GLOB sources CONFIGURE_DEPENDS ${folder}/*.cpp)
  if(NOT sources)
    message(FATAL_ERROR "limn_add_technique(${name}): no *.cpp in ${folder}; name the technique's folder: "
                        "limn_add_technique(${name} FOLDER)")
  endif()
  file(GLOB shaders CONFIGURE_DEPENDS ${folder}/*.glsl)
  add_library(technique_${name} MODULE ${sources})
  target_link_libraries(technique_${name} PRIVATE limn::limn)
  target_compile_definitions(technique_${name} PRIVATE LIMN_TECHNIQUE_ID=${name})
  if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
    # CMake would not optimise, and the technique's times would not be comparable with those of limn's own.
    separate_arguments(release UNIX_COMMAND "${CMAKE_CXX_FLAGS_RELEASE}")
    target_compile_options(technique_${name} PRIVATE ${release})
  endif()
  set_target_properties(technique_${name} PROPERTIES PREFIX "" OUTPUT_NAME ${name}
    CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON
    # One path for the built and the installed module: CMake fills up a shorter path of its own with empty entries.
    INSTALL_RPATH "$ORIGIN/../.." BUILD_WITH_INSTALL_RPATH ON
    LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib/limn/techniques)
  limn_interface_hash(technique_${name} limn_technique_${name}::interfaceHash)
  limn_embed(technique_${name} limn_technique_${name}::embeddedSources ${folder} ${shaders})
  include(${folder}/technique.cmake OPTIONAL)
  install(TARGETS technique_${name} LIBRARY DESTINATION ${LIMN_INSTALL_LIBDIR}/limn/techniques)
endfunction()
