// A texel of the specular buffers: shading normal and which surface it is, and linear depth. BACK 1: only the instance
// that the front buffer shows there.
#include "glsl/language.glsl"

layout(location = 0) in vec3 normal_ws;
layout(location = 1) in float linear_depth;
layout(location = 2) flat in uvec2 surface;  // draw instance, layer

layout(location = 0) out vec4 stored_surface;  // xyz: normal; w: +-(instance + 1), negative where the back is seen
layout(location = 1) out float stored_depth;

#if BACK
layout(binding = 8) uniform sampler2DArray front;
#endif

void main() {
  float id = float(surface.x + 1u);
#if BACK
  if (abs(texelFetch(front, ivec3(ivec2(gl_FragCoord.xy), surface.y), 0).w) != id) discard;
#endif
  float size = length(normal_ws);
  stored_surface = vec4(size > 0.0 ? normal_ws / size : vec3(0.0), gl_FrontFacing ? id : -id);
  stored_depth = linear_depth < 1.0 ? max(linear_depth, 0.0) : 1.0;  // NaN: nothing there
}
