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

# limn_unite_tests(TARGET SOURCES...): up to eight tests of a folder at a time, for builds of everything. Building all of them
# takes two thirds of the time then; building one that was changed takes as long as its group.
option(LIMN_UNITE_TESTS "Compile several tests at once" OFF)

function(limn_unite_tests target)
  if(LIMN_UNITE_TESTS)
    foreach(source IN LISTS ARGN)
      get_filename_component(folder ${source} DIRECTORY)
      get_filename_component(folder ${folder} NAME)
      math(EXPR in_${folder} "0${in_${folder}} + 1")
      math(EXPR part "(${in_${folder}} - 1) / 8")
      set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${folder}_${part})
    endforeach()
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
    if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
      target_compile_options(${target} PRIVATE -Wno-subobject-linkage)
    endif()
  endif()
endfunction()
