// The triangle that a fragment belongs to, for fragment shaders of surfaces.
#ifndef LIMN_TRIANGLE_INPUT_GLSL
#define LIMN_TRIANGLE_INPUT_GLSL
#include "glsl/scene/blocks.glsl"

layout(location = 4) flat in uvec3 surface_instance;  // draw instance, first vertex, first index

layout(std430) readonly buffer Instances { Instance instances[]; };
layout(std430) readonly buffer Positions { float positions[]; };
layout(std430) readonly buffer Indices { uint indices[]; };

vec3 corner(int k) {
  uint vertex = surface_instance.y + indices[surface_instance.z + 3u * uint(gl_PrimitiveID) + uint(k)];
  return vec3(positions[3u * vertex], positions[3u * vertex + 1u], positions[3u * vertex + 2u]);
}

// Normal of the triangle from its corners, against `view_direction`: exact however small the triangle is on the screen, where
// derivatives of interpolated positions are not.
vec3 triangle_normal(vec3 view_direction) {
  vec3 a = corner(0);
  mat3 linear = mat3(instances[surface_instance.x].object_to_world);
  vec3 e = linear * (corner(1) - a);
  vec3 f = linear * (corner(2) - a);
  float scale = max(max(max(abs(e.x), abs(e.y)), abs(e.z)), max(max(abs(f.x), abs(f.y)), abs(f.z)));
  vec3 n = cross(e / scale, f / scale);
  float squared = dot(n, n);
  if (!(squared > 0.0)) return -view_direction;
  n *= inversesqrt(squared);
  return dot(n, view_direction) > 0.0 ? -n : n;
}

#endif  // LIMN_TRIANGLE_INPUT_GLSL
