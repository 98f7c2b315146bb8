// Packs what points of neighbours ask a pixel for.
#include "glsl/diffusion/eye_plane.glsl"
#include "glsl/surface/gbuffer_input.glsl"
#include "techniques/subsurface_scattering/entry_texel.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
uniform sampler2D entering;
layout(rgba32ui) writeonly uniform uimage2D planes;
layout(rg32ui) writeonly uniform uimage2D entries;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.frame_size)))) return;
  uint flags = gbuffer_stored_flags(texelFetch(gbuffer_material, pixel, 0));
  float depth = pixel_depth(pixel);
  bool translucent = depth > 0.0 && (flags & gbuffer_flag_translucent) != 0u;
  vec3 plane = eye_plane(max(depth, 1e-30) * pixel_ray(pixel), pixel_geometric_normal(pixel));
  uint instance = translucent ? pixel_instance(pixel) : no_instance;
  vec3 light = max(texelFetch(entering, pixel, 0).rgb, vec3(0.0));
  imageStore(planes, pixel, uvec4(floatBitsToUint(plane), instance));
  imageStore(entries, pixel, uvec4(entry_pack(floatBitsToUint(light)), 0u, 0u));
}
