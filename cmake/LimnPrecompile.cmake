# Precompiled headers: what most files include of the standard library, fmt and glm, parsed once for each kind of target.
# limn_precompile(TARGET [EXTRA HEADERS...]): makes them for TARGET, and for those that reuse its own.
# limn_reuse_precompiled(TARGET OWNER): TARGET is compiled with the settings of OWNER and uses its headers.
option(LIMN_PRECOMPILE "Parse the headers that most files include once" ON)
if(LIMN_CCACHE AND CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  add_compile_options(-fpch-preprocess)  # or ccache cannot tell what a precompiled header holds
endif()

set(LIMN_PRECOMPILED_HEADERS <algorithm> <array> <cmath> <cstdint> <cstring> <filesystem> <functional> <limits> <map>
    <memory> <optional> <span> <string> <string_view> <utility> <vector> <fmt/format.h> <glm/glm.hpp>)

function(limn_precompile target)
  if(LIMN_PRECOMPILE)
    target_precompile_headers(${target} PRIVATE ${LIMN_PRECOMPILED_HEADERS} ${ARGN})
  endif()
endfunction()

function(limn_reuse_precompiled target owner)
  if(LIMN_PRECOMPILE)
    target_precompile_headers(${target} REUSE_FROM ${owner})
  endif()
endfunction()
