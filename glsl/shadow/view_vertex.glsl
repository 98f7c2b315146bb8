// Vertices of what the views of shadow maps see. LAYERED 1: all views in one draw, each to its own layer. Include this before
// anything else.
#ifndef LIMN_VIEW_VERTEX_GLSL
#define LIMN_VIEW_VERTEX_GLSL
#if LAYERED
#ifdef GL_ARB_shader_viewport_layer_array
#extension GL_ARB_shader_viewport_layer_array : require
#else
#extension GL_AMD_vertex_shader_layer : require
#endif
#endif
#include "glsl/scene/blocks.glsl"
#include "glsl/shadow/shadow_view.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in uvec2 entry;  // x: draw instance, y: view
layout(location = 3) in vec2 uv;
layout(location = 4) in vec4 colour;

layout(std430) readonly buffer Instances { Instance instances[]; };
layout(std430) readonly buffer Views { ShadowView views[]; };

layout(location = 0) out float linear_depth;  // linear in the view's depth, so interpolated exactly

// Where the vertex is in the world, metres, having put it where the view has it.
vec3 place_vertex(ShadowView view) {
  vec3 world = (instances[entry.x].object_to_world * vec4(position, 1.0)).xyz;
  gl_Position = shadow_clip(view, world);
  linear_depth = shadow_normalise(view, shadow_view_depth(view, world));
#if LAYERED
  gl_Layer = int(view.layer);
#endif
  return world;
}

#endif  // LIMN_VIEW_VERTEX_GLSL
