// Depth of the scene from the views of shadow maps. MASKED 1: passes on what an alpha test needs.
#include "glsl/shadow/view_vertex.glsl"

#if MASKED
layout(location = 1) out vec2 surface_uv;
layout(location = 2) out float surface_alpha;
layout(location = 3) flat out uint material_index;
#endif

void main() {
  ShadowView view = views[entry.y];
  vec3 world = place_vertex(view);
#if MASKED
  surface_uv = uv;
  surface_alpha = colour.a;
  material_index = instances[entry.x].material;
#endif
}
