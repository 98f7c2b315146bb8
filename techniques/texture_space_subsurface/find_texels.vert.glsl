// The triangles of a body as the camera sees them. Clip depth as in the G-buffer.
#include "techniques/texture_space_subsurface/body_corner.glsl"

uniform float near_plane;  // m

layout(location = 0) out vec2 place;
layout(location = 1) flat out uvec3 part;  // layer, chart, draw instance

void main() {
  ChartCorner own = corners[gl_VertexID];
  vec4 clip = frame.world_to_clip * vec4(corner_position(body_instance(), own), 1.0);
  gl_Position = vec4(clip.xy, near_plane, clip.w);
  place = own.place;
  part = uvec3(layer, own.chart, bodies[layer].instance);
}
