// A triangle of a paraboloid map as the box of texels around it: its edges are arcs, so the fragment shader asks for each
// texel whether its ray meets the triangle. That is exact however large triangles are, where projected corners joined by
// straight lines are not. Triangles between the centres of texels end here.
#include "glsl/shadow/paraboloid.glsl"

layout(triangles) in;
layout(triangle_strip, max_vertices = 4) out;

layout(location = 0) in vec3 corner[];
layout(location = 1) flat in uint view_index[];
layout(location = 0) flat out vec3 corner_a;
layout(location = 1) flat out vec3 corner_b;
layout(location = 2) flat out vec3 corner_c;
layout(location = 3) flat out vec3 depths;  // near, far, m; texels per side
#if MASKED
layout(location = 2) in vec3 coverage[];
layout(location = 3) flat in uint corner_material[];
layout(location = 4) flat out vec3 coverage_a;
layout(location = 5) flat out vec3 coverage_b;
layout(location = 6) flat out vec3 coverage_c;
layout(location = 7) flat out uint material_index;
#endif

layout(std430) readonly buffer Views { ShadowView views[]; };

void emit(vec2 place, ShadowView view) {
  corner_a = corner[0];
  corner_b = corner[1];
  corner_c = corner[2];
  depths = vec3(view.near, view.far, float(view.size));
#if MASKED
  coverage_a = coverage[0];
  coverage_b = coverage[1];
  coverage_c = coverage[2];
  material_index = corner_material[0];
#endif
  gl_Layer = int(view.layer);
  gl_Position = vec4(2.0 * place / float(view.size) - 1.0, 0.5, 1.0);
  EmitVertex();
}

void main() {
  if (corner[0].z < 0.0 && corner[1].z < 0.0 && corner[2].z < 0.0) return;
  ShadowView view = views[view_index[0]];
  float size = float(view.size);
  // Texel i has its centre at i + 1/2. The margin makes up for rounding.
  vec4 box = (0.5 * paraboloid_bounds(corner[0], corner[1], corner[2]) + 0.5) * size;
  vec2 low = max(ceil(box.xy - 0.501), 0.0);
  vec2 high = min(floor(box.zw + 0.501), size);
  if (!(low.x < high.x && low.y < high.y)) return;
  emit(low, view);
  emit(vec2(high.x, low.y), view);
  emit(vec2(low.x, high.y), view);
  emit(high, view);
}
