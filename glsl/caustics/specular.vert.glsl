// Specular objects as the views of caustic rays see them. BACK 1: the farthest surface wins instead of the nearest.
// GEOMETRIC_NORMALS 1: passes on what triangles' normals need. MASKED 1: what an alpha test needs. COLOURS 1: vertex colours.
#include "glsl/scene/blocks.glsl"
#include "glsl/shadow/shadow_view.glsl"
#include "glsl/geometry/vertex.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in uvec2 entry;  // x: draw instance, y: view
layout(location = 2) in uvec2 directions;

layout(std430) readonly buffer Instances { Instance instances[]; };
layout(std430) readonly buffer Views { ShadowView views[]; };

layout(location = 0) out vec3 normal_ws;
layout(location = 1) out float linear_depth;
#if MASKED
layout(location = 3) in vec2 uv;
layout(location = 2) out vec2 surface_uv;
#if COLOURS
layout(location = 4) in vec4 colour;
layout(location = 3) out vec4 surface_colour;
#endif
#endif
layout(location = 4) flat out uvec3 surface_instance;  // draw instance, first vertex, first index
layout(location = 5) flat out uint layer;
#if GEOMETRIC_NORMALS
layout(location = 6) out vec3 from_eye;  // of the view, towards the surface
#endif

void main() {
  ShadowView view = views[entry.y];
  vec3 world = (instances[entry.x].object_to_world * vec4(position, 1.0)).xyz;
  gl_Position = shadow_clip(view, world);
#if BACK
  gl_Position.z = gl_Position.w - gl_Position.z;
#endif
  normal_ws = mat3(instances[entry.x].normal_to_world) * vertex_unpack_normal(directions.x);
  linear_depth = shadow_normalise(view, shadow_view_depth(view, world));
  layer = view.layer;
#if GEOMETRIC_NORMALS
  from_eye = view.projection == shadow_orthographic ? view.axis_z : world - view.origin;
#endif
  surface_instance = uvec3(entry.x, instances[entry.x].first_vertex, instances[entry.x].first_index);
#if MASKED
  surface_uv = uv;
#if COLOURS
  surface_colour = colour;
#endif
#endif
}
