// Virtual point lights at Halton points of reflective shadow maps. The third coordinate chooses the layer, in proportion
// to the flux it reflects, group by group; the other two the texel. Such a light carries the flux of 1 / (N p) of its
// layer, where p is the layer's share of all flux, and stands for as much of the surfaces that the layer sees, over the number of
// the group's layers, which all see the same. Its flux.w is the group's first layer: what conserve_flux needs.
//
// SETS: frame i has set i % SETS; 1: all frames have the same. The sets of a sub-buffer of interleaved pixels follow each other
// in the sequence, so that over all sets it has the points that it would have of SETS times as many lights.
#include "glsl/numeric/halton.glsl"
#include "glsl/indirect/map_groups.glsl"
#include "glsl/indirect/reflective_texel.glsl"
#include "glsl/indirect/virtual_light.glsl"
#if SETS > 1
#include "glsl/indirect/gather.glsl"
#include "glsl/scene/blocks.glsl"
#endif

layout(local_size_x = 64) in;
layout(std430) readonly buffer LayerFlux { vec4 layer_flux[]; };
layout(std430) writeonly buffer VirtualLights { VirtualPointLight virtual_lights[]; };
uniform uint count;  // of virtual lights
#if SETS > 1
uniform uint block;  // side of the pattern of sub-buffers
#endif

void main() {
  uint index = gl_GlobalInvocationID.x;
  if (index >= count) return;
#if SETS > 1
  uint sub_buffer = gather_sub_buffer(index, count, block);
  uint first = gather_begin(sub_buffer, count, block);
  uint points = gather_begin(sub_buffer + 1u, count, block) - first;
  uint number = uint(SETS) * first + frame.frame_index % uint(SETS) * points + index - first;
#else
  uint number = index;
#endif
  vec3 at = halton_point(number + 1u);
  float total = 0.0;
  for (uint l = 0u; l < layers; ++l) total += flux_weight(layer_flux[l].rgb);
  float wanted = at.z * total;
  float before = 0.0;
  uint layer = 0u;
  uint group = 0u;
  uint in_group = 1u;  // layers
  float weight = 0.0;
  for (uint light = 0u; light < light_count; ++light) {
    LightLayers of_light = light_layers(light);
    for (uint face = 0u; face < of_light.faces; ++face) {
      // the last layer with flux that begins at or before what is wanted
      for (uint point = 0u; point < of_light.points; ++point) {
        uint l = of_light.first + point * of_light.faces + face;
        float own = flux_weight(layer_flux[l].rgb);
        if (own > 0.0 && before <= wanted) {
          layer = l;
          group = of_light.first + face;
          in_group = of_light.points;
          weight = own;
        }
        before += own;
      }
    }
  }
  ShadowView view = views[layer];
  ivec2 texel = ivec2(at.xy * float(view.size));
  ReflectiveTexel t = reflective_texel(view, texel);
  VirtualPointLight light;
  light.position = t.position;
  light.cluster = 0.0;
  vec3 ray = t.position - view.origin;
  bool parallel = view.projection == shadow_orthographic;
  float lengthened = parallel ? 1.0 : dot(ray, ray);  // m^2 across the light per unit of its measure
  vec3 towards = parallel || lengthened <= 0.0 ? view.axis_z : normalize(ray);  // no ray: the texel holds nothing
  float slant = max(abs(dot(towards, t.normal)), reflective_map_least_cosine);
  float measure = reflective_map_measure(view, (vec2(texel) + 0.5) / float(view.size));
  light.area = weight > 0.0 ? measure * lengthened / slant * (total / (weight * float(count) * float(in_group))) : 0.0;
  light.normal = t.normal;
  light.flux = vec4(weight > 0.0 ? t.flux * (total / (weight * float(count))) : vec3(0.0), float(group));
  virtual_lights[index] = light;
}
