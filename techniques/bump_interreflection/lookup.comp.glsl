// Adds what the texels of flat bases have gathered in bounce number `bounce` of one light that is far away.
// VISIBILITY 1: other surfaces shadow it. BETWEEN 0: of the texel nearest to the pixel's centre; 1: linear between texels.
#include "glsl/relief/relief_maps.glsl"
#include "techniques/bump_interreflection/bump_pixel.glsl"
#include "techniques/bump_interreflection/flat_base.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(std430) readonly buffer FlatBases { FlatBase flat_bases[]; };
layout(std430) readonly buffer Gathered { float gathered[]; };
uniform uint light_index;
uniform int layer;  // of the light in its batch
uniform int bounce;  // from 1 on

// A pixel that is wider than a texel looks at several places.
const int most_places = 16;

float gathered_at(FlatBase base, ReliefField field, vec2 place) {
  ReliefTexels t = relief_texels(field.size, field.clamped != 0u, place);
  vec4 values;
  for (int k = 0; k < 4; ++k) values[k] = gathered[base.first + uint(t.index[k])];
  return relief_bilinear(values, t.part);
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.frame_size)))) return;
  PixelRelief here = pixel_relief(pixel);
  if (here.height < 0) return;
  uint index = bases_of_instances[pixel_instance(pixel)];
  if (index == no_instance) return;
  vec3 albedo = pixel_albedo(pixel);
  vec3 sender = sender_albedo(pixel, albedo);
  FlatBase base = flat_bases[index];
  ReliefField field = relief_fields[here.height];
  vec2 place = relief_place(here.uv, field.size);
#if BETWEEN
  float wider = exp2(here.level) - 1.0;  // than what is linear between texels
  int places = wider > 0.0 ? most_places : 1;
  float sum = 0.0;
  int i = 0;
  do {
    sum += gathered_at(base, field, footprint_place(place, wider, i, places));
  } while (++i < places);
  float share = sum / float(places);
#else
  float share = gathered_at(base, field, floor(place + 0.5));
#endif
  vec3 position = pixel_position(pixel, pixel_depth(pixel));
  vec3 light = arriving_light(lights[light_index], position, pixel, layer) * (share * inverse_pi) * albedo;
  for (int i = 0; i < bounce; ++i) light *= sender;
  if (light == vec3(0.0)) return;
  imageStore(radiance, pixel, imageLoad(radiance, pixel) + vec4(light, 0.0));
}
