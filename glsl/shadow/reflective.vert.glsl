// Surfaces as the views of reflective shadow maps see them. COLOURS 1: vertex colours.
#include "glsl/shadow/view_vertex.glsl"

layout(location = 1) out vec3 from_light;  // metres; parallel light: unit
layout(location = 2) out vec2 surface_uv;
#if COLOURS
layout(location = 3) out vec4 surface_colour;
#endif
layout(location = 4) flat out uvec3 surface_instance;  // draw instance, first vertex, first index

void main() {
  surface_instance = uvec3(entry.x, instances[entry.x].first_vertex, instances[entry.x].first_index);
  ShadowView view = views[entry.y];
  vec3 world = place_vertex(view);
  from_light = view.projection == shadow_orthographic ? view.axis_z : world - view.origin;
  surface_uv = uv;
#if COLOURS
  surface_colour = colour;
#endif
}
