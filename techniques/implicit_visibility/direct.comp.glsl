// What leaves reflect of the lights and of the environment, and so send on.
#include "glsl/unshadowed_light.glsl"
#include "techniques/implicit_visibility/elements.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Lights { Light lights[]; };
layout(std430, binding = 1) readonly buffer Leaves { Leaf leaves[]; };
layout(std430, binding = 2) writeonly buffer Direct { vec4 direct[]; };
layout(std430, binding = 3) writeonly buffer Outgoing { vec4 outgoing[]; };  // the same, to be pulled up
#if LIGHTS
layout(std430, binding = 4) readonly buffer Indices { uint indices[]; };
layout(std430, binding = 5) readonly buffer Seen { float seen[]; };
#endif
#if ENVIRONMENT
layout(std430, binding = 6) readonly buffer Sky { vec4 sky[]; };
#endif
uniform uint slots;
uniform uint light_count;

void main() {
  uint slot = gl_GlobalInvocationID.x;
  if (slot >= slots) return;
  Leaf leaf = leaves[slot];
  vec3 sum = vec3(0.0);
  if (leaf.vertex.w > 0.0) {
#if LIGHTS
    SurfaceBrdf white = surface_brdf(vec3(1.0), 0.0, 1.0, 0.0, vec3(1.0), 1.5);
    vec3 n = leaf.normal.xyz;
    for (uint l = 0u; l < light_count; ++l)
      sum += seen[l * slots + slot] * unshadowed_light(lights[indices[l]], white, leaf.position.xyz, n, n, n);
#endif
#if ENVIRONMENT
    sum += sky[slot].rgb * inverse_pi;
#endif
  }
  direct[slot] = outgoing[slot] = vec4(leaf.albedo.rgb * sum, 0.0);
}
