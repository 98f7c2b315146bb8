// Surfaces as the views of reflective shadow maps see them. LAYERED 1: all views in one draw, each to its own layer.
// COLOURS 1: vertex colours.
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

layout(std430) readonly buffer Instances { Instance instances[]; };
layout(std430) readonly buffer Views { ShadowView views[]; };

layout(location = 0) out float linear_depth;
layout(location = 1) out vec3 from_light;  // metres; parallel light: unit
layout(location = 2) out vec2 surface_uv;
#if COLOURS
layout(location = 4) in vec4 colour;
layout(location = 3) out vec4 surface_colour;
#endif
layout(location = 4) flat out uvec3 surface_instance;  // draw instance, first vertex, first index

void main() {
  surface_instance = uvec3(entry.x, instances[entry.x].first_vertex, instances[entry.x].first_index);
  ShadowView view = views[entry.y];
  vec3 world = (instances[entry.x].object_to_world * vec4(position, 1.0)).xyz;
  gl_Position = shadow_clip(view, world);
  linear_depth = shadow_normalise(view, shadow_view_depth(view, world));
  from_light = view.projection == shadow_orthographic ? view.axis_z : world - view.origin;
  surface_uv = uv;
#if COLOURS
  surface_colour = colour;
#endif
#if LAYERED
  gl_Layer = int(view.layer);
#endif
}
