// The light that enters at points, E / pi.
#include "glsl/numeric/work_items.glsl"
#include "glsl/shadow/entering_light.glsl"
#include "techniques/hierarchical_subsurface/scatter_tree.glsl"

layout(local_size_x = 64) in;
layout(std430) readonly buffer Points { ScatterPoint points[]; };
layout(std430) writeonly buffer Entering { vec4 entering_light[]; };
uniform uint point_count;
#if LIGHT_COUNT
layout(std430) readonly buffer Bodies { ScatterBody bodies[]; };
#endif

void main() {
  uint index = work_item_index();
  if (index >= point_count) return;
  ScatterPoint point = points[index];
  vec3 light = vec3(0.0);
  if (point.instance != no_instance) {
    float eta = 1.0;
#if LIGHT_COUNT
    eta = bodies[point.instance].eta;
#endif
    light = light_that_enters(EntryPlace(point.position, point.normal, point.instance, point.reach), eta);
  }
  entering_light[index] = vec4(light, 0.0);
}
