// A texel of the specular buffers: shading normal and which surface it is, linear depth, and, with GEOMETRIC_NORMALS, the
// triangle's normal. BACK 1: only the instance that the front buffer shows there. MASKED 1: alpha test first; TEXTURES, COLOURS:
// see surface_input.glsl.
#include "glsl/surface/gbuffer.glsl"
#include "glsl/geometry/triangle_input.glsl"
#if MASKED
#include "glsl/geometry/surface_input.glsl"
#endif

layout(location = 0) in vec3 normal_ws;
layout(location = 1) in float linear_depth;
layout(location = 5) flat in uint layer;
#if GEOMETRIC_NORMALS
layout(location = 6) in vec3 from_eye;
#endif

layout(location = 0) out vec4 stored_surface;  // xyz: normal; w: +-(instance + 1), negative where the back is seen
layout(location = 1) out float stored_depth;
#if GEOMETRIC_NORMALS
layout(location = 2) out vec2 stored_geometric_normal;  // octahedral, of the front face
#endif

#if BACK
uniform sampler2DArray front;
#endif

void main() {
#if MASKED
  alpha_test();
#endif
  float id = float(surface_instance.x + 1u);
#if BACK
  if (abs(texelFetch(front, ivec3(ivec2(gl_FragCoord.xy), layer), 0).w) != id) discard;
#endif
  float size = length(normal_ws);
  stored_surface = vec4(size > 0.0 ? normal_ws / size : vec3(0.0), gl_FrontFacing ? id : -id);
#if GEOMETRIC_NORMALS
  vec3 triangle = triangle_normal(normalize(from_eye));
  stored_geometric_normal = octahedral_encode(gl_FrontFacing ? triangle : -triangle);
#endif
  stored_depth = linear_depth < 1.0 ? max(linear_depth, 0.0) : 1.0;  // NaN: nothing there
}
