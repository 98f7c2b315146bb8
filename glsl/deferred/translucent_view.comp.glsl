// The G-buffer with translucent surfaces as the light meets them that is to be added up. ENTERING 0: their boundaries, which
// reflect without what lies below. ENTERING 1: what enters them; its mean share is the base colour, and other surfaces count as
// specular, which take no light.
#include "glsl/materials/entry.glsl"
#include "glsl/surface/gbuffer_input.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba16) writeonly uniform image2D albedo;
#if ENTERING
layout(rgba8) writeonly uniform image2D material;
#endif

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.frame_size)))) return;
  vec4 colour = texelFetch(gbuffer_albedo, pixel, 0);
  vec4 constants = texelFetch(gbuffer_material, pixel, 0);
  bool translucent = (gbuffer_stored_flags(constants) & gbuffer_flag_translucent) != 0u;
#if ENTERING
  float share = translucent ? entry_model(gbuffer_stored_ior(constants)).kd.x : 0.0;
  imageStore(albedo, pixel, vec4(gbuffer_colour_encode(vec3(share)), 0.0));
  imageStore(material, pixel, vec4(1.0, 0.0, constants.z, translucent ? 0.0 : float(gbuffer_flag_specular) / 255.0));
#else
  imageStore(albedo, pixel, translucent ? vec4(0.0) : colour);
#endif
}
