// How a material's model reflects light: exactly, or as the technique that answers the term `surface` has it. SURFACE_ANSWER:
// the file of that technique, which defines material_response() itself.
#ifndef LIMN_RESPONSE_GLSL
#define LIMN_RESPONSE_GLSL
#include "glsl/materials/model.glsl"
#ifdef SURFACE_ANSWER
#include SURFACE_ANSWER
#else
LIMN_BEGIN

// f(v, l) times the cosine of l, 1/sr, in the model's frame (n: +z, tangent: +x); 0 where l lies below the horizon.
LIMN_FN vec3 material_response(MaterialModel m, vec3 v, vec3 l) { return model_response(m, v, l); }

LIMN_END
#endif

#endif  // LIMN_RESPONSE_GLSL
