// Lays the triangles of a body out in its texture.
#include "techniques/texture_space_subsurface/body_corner.glsl"

uniform float texels;  // across the texture

layout(location = 0) out vec3 place_ws;
layout(location = 1) flat out vec3 normal_ws;
layout(location = 2) flat out vec2 texel_size;  // m, along u and v
layout(location = 3) flat out uint chart;

void main() {
  int first = gl_VertexID / 3 * 3;
  Instance body = body_instance();
  ChartCorner own = corners[gl_VertexID];
  ChartCorner a = corners[first];
  ChartCorner b = corners[first + 1];
  ChartCorner c = corners[first + 2];
  vec3 start = corner_position(body, a);
  vec3 e = corner_position(body, b) - start;
  vec3 f = corner_position(body, c) - start;
  vec3 across = cross(e, f);
  float square = dot(across, across);
  bool mirrored = (body.flags & instance_mirrored) != 0u;
  normal_ws = square > 0.0 ? across * ((mirrored ? -1.0 : 1.0) * inversesqrt(square)) : vec3(0.0, 1.0, 0.0);
  // How far the surface goes for a texel along u and v: the inverse of (b - a, c - a) in texels, times e and f.
  vec2 p = b.place - a.place;
  vec2 q = c.place - a.place;
  float area = p.x * q.y - p.y * q.x;
  float inverse_area = area != 0.0 ? 1.0 / area : 0.0;
  texel_size = inverse_area * vec2(length(q.y * e - p.y * f), length(p.x * f - q.x * e));
  texel_size = abs(texel_size);
  place_ws = corner_position(body, own);
  chart = own.chart;
  gl_Position = vec4(2.0 * own.place / texels - 1.0, 0.0, 1.0);
}
