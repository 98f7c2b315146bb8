# Unity builds: a folder's sources compiled as one, in half the time. scripts/build asks for it where there are no tests, since some
# of these need commands of single sources.
# limn_unite(TARGET GROUP SOURCES...): makes the sources of TARGET such a group. The test structure.unity compiles them so.
option(LIMN_UNITY "Compile the sources of each folder at once" OFF)

function(limn_unite target group)
  if(LIMN_UNITY)
    set_source_files_properties(${ARGN} PROPERTIES UNITY_GROUP ${group})
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
    if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
      target_compile_options(${target} PRIVATE -Wno-subobject-linkage)  # which takes the sources for headers
    endif()
  endif()
endfunction()
