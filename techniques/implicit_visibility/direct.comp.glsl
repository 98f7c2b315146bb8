// What leaves reflect of the lights and, with ENVIRONMENT, of the sky, and so send on. With GLOSSY a thread for each direction, and
// lights alone. LIGHT_TEXTURES: see light_texture.glsl. MEDIUM 1: light of lights is attenuated on its way to the leaf.
// LIGHTS_FIRST, LIGHTS_LAST: nothing was added before these lights, or will be after them.
#include "glsl/light/light_texture.glsl"
#include "glsl/light/unshadowed_light.glsl"
#include "glsl/media/light_transmittance.glsl"
#include "techniques/implicit_visibility/elements.glsl"

layout(local_size_x = 64) in;
layout(std430) readonly buffer Lights { Light lights[]; };
layout(std430) readonly buffer Leaves { Leaf leaves[]; };
#if LIGHTS_FIRST
layout(std430) writeonly buffer Direct { vec4 direct[]; };
#else
layout(std430) buffer Direct { vec4 direct[]; };
#endif
#if LIGHTS_LAST
layout(std430) writeonly buffer Outgoing { vec4 outgoing[]; };  // the same, to be pulled up
#endif
#if LIGHTS
layout(std430) readonly buffer Indices { uint indices[]; };
layout(std430) readonly buffer Seen { float seen[]; };
layout(std430) readonly buffer Groups { ElementGroup groups[]; };
#endif
#if ENVIRONMENT
layout(std430) readonly buffer Sky { vec4 sky[]; };
#endif
#if GLOSSY
layout(std430) readonly buffer Materials { SurfaceBrdf materials[]; };  // limn::radiosity::LeafMaterial
#endif
uniform uint slots;
uniform uint light_count;

void main() {
  uint item = work_item_index();
  uint slot = item / sent_count;
  if (slot >= slots) return;
  Leaf leaf = leaves[slot];
  vec3 n = leaf.normal.xyz;
#if GLOSSY
  SurfaceBrdf surface = binned_brdf(materials[slot]);
  vec3 view = from_bins(sent_direction(item % sent_count));
  bool sends = leaf.used > 0.0 && dot(view, n) > 0.0;
#else
  SurfaceBrdf surface = SurfaceBrdf(leaf.albedo, 1.0, vec3(0.0), 0.0, 0.0, 0.0);
  vec3 view = n;
  bool sends = leaf.used > 0.0;
#endif
  vec3 sum = vec3(0.0);
  if (sends) {
#if !LIGHTS_FIRST
    sum = direct[item].rgb;
#endif
#if LIGHTS
    for (uint l = 0u; l < light_count; ++l) {
      if (light_is_instance(lights[indices[l]], groups[slot / 4u].object)) continue;
      vec3 lit = seen[l * slots + slot] * unshadowed_light(lights[indices[l]], surface, leaf.position.xyz, n, n, view) *
                 light_texture(lights[indices[l]], leaf.position.xyz);
#if MEDIUM
      lit *= light_transmittance(lights[indices[l]], leaf.position.xyz);
#endif
      sum += lit;
    }
#endif
#if ENVIRONMENT
    sum += leaf.albedo * sky[slot].rgb * inverse_pi;
#endif
  }
  direct[item] = vec4(sum, 0.0);
#if LIGHTS_LAST
  outgoing[item] = vec4(sum, 0.0);
#endif
}
