// Corners of the triangles of charts, for vertex shaders.
#ifndef BODY_CORNER_GLSL
#define BODY_CORNER_GLSL
#include "glsl/scene/blocks.glsl"
#include "techniques/texture_space_subsurface/body_texture.glsl"

layout(std430) readonly buffer Corners { ChartCorner corners[]; };
layout(std430) readonly buffer Bodies { TexturedBody bodies[]; };
layout(std430) readonly buffer Instances { Instance instances[]; };
layout(std430) readonly buffer Positions { float positions[]; };
uniform uint layer;

Instance body_instance() { return instances[bodies[layer].instance]; }

// World, m.
vec3 corner_position(Instance body, ChartCorner corner) {
  uint vertex = body.first_vertex + corner.vertex;
  vec3 own = vec3(positions[3u * vertex], positions[3u * vertex + 1u], positions[3u * vertex + 2u]);
  return (body.object_to_world * vec4(own, 1.0)).xyz;
}

#endif  // BODY_CORNER_GLSL
