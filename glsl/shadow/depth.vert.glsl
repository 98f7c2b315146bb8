// Depth of the scene from the views of shadow maps. LAYERED 1: all views in one draw, each to its own layer.
// MASKED 1: passes on what an alpha test needs. PARABOLOID 1: some views are paraboloids, whose clip coordinates do not
// cut off what lies behind them.
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
#if MASKED
layout(location = 3) in vec2 uv;
layout(location = 4) in vec4 colour;
layout(location = 1) out vec2 surface_uv;
layout(location = 2) out float surface_alpha;
layout(location = 3) flat out uint material_index;
#endif
layout(location = 0) out float linear_depth;  // linear in the view's depth, so interpolated exactly

layout(std430) readonly buffer Instances { Instance instances[]; };
layout(std430) readonly buffer Views { ShadowView views[]; };

void main() {
  ShadowView view = views[entry.y];
  vec3 world = (instances[entry.x].object_to_world * vec4(position, 1.0)).xyz;
  gl_Position = shadow_clip(view, world);
  linear_depth = shadow_normalise(view, shadow_view_depth(view, world));
#if PARABOLOID
  vec3 local = shadow_local(view, world);
  gl_ClipDistance[0] = view.projection == shadow_paraboloid ? local.z + 0.1 * length(local) : 1.0;
#endif
#if MASKED
  surface_uv = uv;
  surface_alpha = colour.a;
  material_index = instances[entry.x].material;
#endif
#if LAYERED
  gl_Layer = int(view.layer);
#endif
}
