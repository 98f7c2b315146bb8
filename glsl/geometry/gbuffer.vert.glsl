// Vertices of the G-buffer. Clip depth is reversed and infinite: z = near, w = view depth. COLOURS 1: vertex colours.
#include "glsl/scene/blocks.glsl"
#include "glsl/geometry/vertex.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in uvec2 entry;  // x: draw instance
layout(location = 2) in uvec2 directions;
layout(location = 3) in vec2 uv;

layout(std430) readonly buffer Instances { Instance instances[]; };
uniform float near_plane;  // metres

layout(location = 0) out vec3 normal_ws;
layout(location = 1) out vec4 tangent_ws;
layout(location = 2) out vec2 surface_uv;
#if COLOURS
layout(location = 4) in vec4 colour;
layout(location = 3) out vec4 surface_colour;
#endif
layout(location = 4) flat out uvec3 surface_instance;  // draw instance, first vertex, first index

void main() {
  surface_instance = uvec3(entry.x, instances[entry.x].first_vertex, instances[entry.x].first_index);
  mat4 object_to_world = instances[entry.x].object_to_world;
  vec4 clip = frame.world_to_clip * (object_to_world * vec4(position, 1.0));
  gl_Position = vec4(clip.xy, near_plane, clip.w);

  vec4 tangent = vertex_unpack_tangent(directions.y);
  normal_ws = mat3(instances[entry.x].normal_to_world) * vertex_unpack_normal(directions.x);
  bool mirrored = (instances[entry.x].flags & instance_mirrored) != 0u;
  tangent_ws = vec4(mat3(object_to_world) * tangent.xyz, mirrored ? -tangent.w : tangent.w);
  surface_uv = uv;
#if COLOURS
  surface_colour = colour;
#endif
}
