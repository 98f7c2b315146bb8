// The light that enters at texels, E / pi; a: the chart, 0 where there is none.
#include "glsl/shadow/entering_light.glsl"
#include "techniques/texture_space_subsurface/body_texture.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(std430) readonly buffer Bodies { TexturedBody bodies[]; };
layout(std430) readonly buffer Kinds { TexturedKind kinds[]; };
uniform sampler2DArray surface_place;
uniform sampler2DArray surface_frame;
layout(rgba32f) writeonly uniform image2DArray lit;

void main() {
  ivec3 texel = ivec3(gl_GlobalInvocationID);
  if (any(greaterThanEqual(texel, imageSize(lit)))) return;
  vec4 place = texelFetch(surface_place, texel, 0);
  vec3 light = vec3(0.0);
  if (place.w != 0.0) {
    vec4 here = texelFetch(surface_frame, texel, 0);
    TexturedBody body = bodies[texel.z];
    EntryPlace entry = EntryPlace(place.xyz, octahedral_decode(here.xy), body.instance, 2.0 * max(here.z, here.w));
    light = light_that_enters(entry, kinds[body.kind].eta);
  }
  imageStore(lit, texel, vec4(light, place.w));
}
