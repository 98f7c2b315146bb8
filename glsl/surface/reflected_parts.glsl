// Reflected light, or a response to light, in the parts that are shadowed and filtered apart.
#ifndef LIMN_REFLECTED_PARTS_GLSL
#define LIMN_REFLECTED_PARTS_GLSL
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

struct ReflectedParts {
  vec3 diffuse;
  vec3 lobe;  // what is not diffuse
};

LIMN_FN vec3 reflected_whole(ReflectedParts p) { return p.diffuse + p.lobe; }

LIMN_END
#endif  // LIMN_REFLECTED_PARTS_GLSL
