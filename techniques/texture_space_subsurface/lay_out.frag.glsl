// What lies at a texel of a body.
layout(location = 0) in vec3 place_ws;
layout(location = 1) flat in vec3 normal_ws;
layout(location = 2) flat in vec2 texel_size;
layout(location = 3) flat in uint chart;
layout(location = 0) out vec4 surface_place;   // world, m; a: chart
layout(location = 1) out vec4 surface_frame;   // normal, octahedral; metres per texel along u and v

#include "glsl/surface/gbuffer.glsl"

void main() {
  surface_place = vec4(place_ws, float(chart));
  surface_frame = vec4(octahedral_encode(normal_ws), texel_size);
}
