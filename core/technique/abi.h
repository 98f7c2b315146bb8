// Declares what determines, beside the headers, the memory layout of the interface's types: settings of the
// compiler and the standard library, and the libraries whose types cross the interface by value.
#pragma once

#include <fmt/core.h>

#include <glm/detail/setup.hpp>
#include <string>

// "NAME=VALUE;" as the preprocessor sees it; a macro that is not defined has its own name for a value.
#define LIMN_ABI_VALUE(value) #value
#define LIMN_ABI_MACRO(macro) #macro "=" LIMN_ABI_VALUE(macro) ";"

namespace limn {

/// Lists the settings that both sides must share, "NAME=VALUE;" for each.
constexpr char kTechniqueAbi[] =
    // Language and data model.
    LIMN_ABI_MACRO(__cplusplus) LIMN_ABI_MACRO(__GXX_ABI_VERSION) LIMN_ABI_MACRO(__SIZEOF_POINTER__)
        LIMN_ABI_MACRO(__SIZEOF_LONG_DOUBLE__)
    // Standard library: which one, its strings, its containers with checks.
    LIMN_ABI_MACRO(_GLIBCXX_RELEASE) LIMN_ABI_MACRO(_GLIBCXX_USE_CXX11_ABI) LIMN_ABI_MACRO(_GLIBCXX_DEBUG)
        LIMN_ABI_MACRO(_LIBCPP_VERSION) LIMN_ABI_MACRO(_LIBCPP_ABI_VERSION)
    // GLM's vectors and quaternions.
    LIMN_ABI_MACRO(GLM_VERSION_MAJOR) LIMN_ABI_MACRO(GLM_VERSION_MINOR) LIMN_ABI_MACRO(GLM_VERSION_PATCH)
        LIMN_ABI_MACRO(GLM_CONFIG_ALIGNED_GENTYPES) LIMN_ABI_MACRO(GLM_CONFIG_SIMD)
            LIMN_ABI_MACRO(GLM_CONFIG_SWIZZLE) LIMN_ABI_MACRO(GLM_CONFIG_XYZW_ONLY)
                LIMN_ABI_MACRO(GLM_FORCE_QUAT_DATA_WXYZ) LIMN_ABI_MACRO(FMT_VERSION);

// Two settings that no macro shows: -fshort-enums and -fpack-struct.
enum AbiEnumeration { abi_enumerator };
struct AbiStructure {
  char first;
  double second;
};
static_assert(sizeof(AbiEnumeration) == sizeof(int), "limn is built without -fshort-enums");
static_assert(sizeof(AbiStructure) == 2 * sizeof(double), "limn is built without -fpack-struct");

}  // namespace limn
