# Installs BUILD to a scratch prefix, then configures, builds and runs what an outsider would write against it.
cmake_minimum_required(VERSION 3.25)
set(scratch ${BUILD}/install_test)
set(prefix ${scratch}/prefix)

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "failed (${result}): ${command}\n${output}")
  endif()
endfunction()

file(REMOVE_RECURSE ${scratch})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix})
# The prefix may be moved: nothing in it names the place it was installed to.
file(RENAME ${prefix} ${scratch}/moved)
foreach(project example_technique loader)
  run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/${project} -B ${scratch}/${project} -G ${GENERATOR}
      -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_PREFIX_PATH=${scratch}/moved)
  run(${CMAKE_COMMAND} --build ${scratch}/${project})
endforeach()
run(${scratch}/loader/load_technique ${scratch}/example_technique/lib/limn/techniques example_technique)
# An out-of-tree technique is installed beside limn's own.
run(${CMAKE_COMMAND} --install ${scratch}/example_technique --prefix ${scratch}/moved)
run(${scratch}/loader/load_technique ${scratch}/moved/${LIBDIR}/limn/techniques example_technique)

# Built against other headers, it is refused with both sides named.
set(header ${scratch}/moved/include/limn/core/technique/interface_hash.h)
file(READ ${header} text)
string(REGEX REPLACE "\"[0-9a-f]+\"" "\"00000000000000000000000000000000\"" text "${text}")
file(WRITE ${header} "${text}")
run(${CMAKE_COMMAND} --build ${scratch}/example_technique)
execute_process(
  COMMAND ${scratch}/loader/load_technique ${scratch}/example_technique/lib/limn/techniques example_technique
  RESULT_VARIABLE result ERROR_VARIABLE message)
if(NOT result EQUAL 1 OR NOT message MATCHES
   "example_technique was refused: it was built against headers 0+, this limn has [0-9a-f]+; rebuild it")
  message(FATAL_ERROR "a technique built against other headers was not refused (${result}): ${message}")
endif()
