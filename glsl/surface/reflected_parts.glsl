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

LIMN_FN void add_parts(LIMN_INOUT(ReflectedParts) sum, ReflectedParts light) {
  sum.diffuse += light.diffuse;
  sum.lobe += light.lobe;
}

LIMN_FN ReflectedParts scaled_parts(ReflectedParts p, vec3 factor) {
  p.diffuse *= factor;
  p.lobe *= factor;
  return p;
}

LIMN_END
#endif  // LIMN_REFLECTED_PARTS_GLSL
