# Unity builds: sources compiled together, in half the time.
# LIMN_UNITY: the folders of core and of the programs. scripts/build asks for it where a new build has no tests: with them each
# source is compiled alone, so that a missing include shows. A build that is there keeps what it has.
# LIMN_UNITY_TESTS: the tests, of which a developer compiles one at a time. scripts/build asks for it where there are tests.
# limn_unite(TARGET GROUP SOURCES...): makes the sources of TARGET such a group. The test structure.unity compiles them so.
# limn_unite_tests(TARGET SOURCES...): makes groups of up to eight, each of one folder, of the sources of a TARGET of tests.
option(LIMN_UNITY "Compile the sources of each folder at once" OFF)
option(LIMN_UNITY_TESTS "Compile several sources of tests at once" OFF)

function(limn_set_unity_group target group)
  set_source_files_properties(${ARGN} PROPERTIES UNITY_GROUP ${group})
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    target_compile_options(${target} PRIVATE -Wno-subobject-linkage)  # which takes the sources for headers
  endif()
endfunction()

function(limn_unite target group)
  if(LIMN_UNITY)
    limn_set_unity_group(${target} ${group} ${ARGN})
  endif()
endfunction()

function(limn_unite_tests target)
  if(LIMN_UNITY_TESTS)
    set(taken 0)
    foreach(source IN LISTS ARGN)
      cmake_path(GET source PARENT_PATH parent)
      if(NOT parent STREQUAL folder)
        set(folder ${parent})
        set(taken 0)
      endif()
      cmake_path(GET folder FILENAME name)
      math(EXPR batch "${taken} / 8")
      math(EXPR taken "${taken} + 1")
      list(APPEND groups ${name}_${batch})
      list(APPEND sources_of_${name}_${batch} ${source})
    endforeach()
    list(REMOVE_DUPLICATES groups)
    foreach(group IN LISTS groups)
      limn_set_unity_group(${target} ${group} ${sources_of_${group}})
    endforeach()
  endif()
endfunction()
