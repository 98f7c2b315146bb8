// Lets one numeric header compile as GLSL and as C++ (through GLM), so that its laws are tested on the CPU
// and the GPU is checked against them.
//
// In C++ everything lands in namespace limn::glsl. A shared header includes this one and looks like this:
//
//     #ifndef LIMN_EXAMPLE_GLSL
//     #define LIMN_EXAMPLE_GLSL
//     LIMN_BEGIN
//     LIMN_FN float half_of(float x) { return 0.5f * x; }
//     LIMN_FN void split(float x, LIMN_OUT(float) whole, LIMN_OUT(float) rest) { ... }
//     LIMN_END
//     #endif
//
// Literals carry an f (GLSL accepts it, C++ needs it). No comment spells the include directive with its
// hash: Mesa looks for a text that does in its cache only after it has preprocessed it, which makes loading it twice as long.
#ifndef LIMN_LANGUAGE_GLSL
#define LIMN_LANGUAGE_GLSL

#ifdef __cplusplus

#include <cmath>
#include <glm/glm.hpp>

#define LIMN_BEGIN     \
  namespace limn {     \
  namespace glsl {     \
  using namespace glm;
#define LIMN_END \
  }              \
  }
#define LIMN_FN inline
#define LIMN_CONST constexpr
#define LIMN_OUT(T) T&
#define LIMN_INOUT(T) T&
#define LIMN_PRECISE

// A std140 uniform block or an std430 buffer element. Both layouts agree with C++ where a scalar follows every vec3, a
// vec2 starts at a multiple of 8 bytes, arrays are of 16-byte members only, and the size is a multiple of 16 bytes.
#define LIMN_UNIFORM_BLOCK(NAME) struct alignas(16) NAME {
#define LIMN_END_UNIFORM_BLOCK(INSTANCE) \
  }                                      \
  ;

#else  // GLSL

#define LIMN_BEGIN
#define LIMN_END
#define LIMN_FN
#define LIMN_CONST const
#define LIMN_OUT(T) out T
#define LIMN_INOUT(T) inout T
#define LIMN_PRECISE precise
#define LIMN_UNIFORM_BLOCK(NAME) layout(std140) uniform NAME {
#define LIMN_END_UNIFORM_BLOCK(INSTANCE) \
  }                                      \
  INSTANCE;

#endif

LIMN_BEGIN
LIMN_CONST float pi = 3.14159265358979f;
LIMN_CONST float inverse_pi = 0.31830988618379f;
LIMN_END

#endif  // LIMN_LANGUAGE_GLSL
