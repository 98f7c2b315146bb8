// Adds light from bump to bump of the height map that a pixel shows, path by path, under a batch of lights. Each path looks at
// another place of the pixel's footprint, which is at least a texel wide: what it meets are texels, and their mean is linear
// between them.
// LIGHT_COUNT: lights of the batch. VISIBILITY 1: other surfaces shadow them. FLAT_BASES 1: instances with a base of their own
// are left to lookup.comp.glsl. BETWEEN 0: all paths are those of the texel nearest to the pixel's centre.
#include "techniques/bump_interreflection/bump_pixel.glsl"
#include "techniques/bump_interreflection/bump_texels.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
uniform uint light_indices[LIGHT_COUNT];
uniform int bounces;

// Of each light: unit vector towards it, of the field's frame, and irradiance across that.
vec3 towards_lights[LIGHT_COUNT];
BumpLight light_places[LIGHT_COUNT];
vec3 arriving[LIGHT_COUNT];

void find_lights(ivec2 pixel, Frame base) {
  vec3 position = pixel_position(pixel, pixel_depth(pixel));
  for (int i = 0; i < LIGHT_COUNT; ++i) {
    Light light = lights[light_indices[i]];
    towards_lights[i] = to_local(base, light_centre_direction(light, position));
    light_places[i] = bump_light(towards_lights[i]);
    arriving[i] = arriving_light(light, position, pixel, i);
  }
}

// Sum over the lights of the irradiance on a texel.
vec3 texel_irradiance(BumpTexels texels, uint texel) {
  vec3 normal = bump_normal(texels, texel);
  vec3 sum = vec3(0.0);
  int i = 0;
  do {  // the condition comes last: software renderers run a loop's body once more where it comes first
    sum += arriving[i] * bump_irradiance(texels, texel, normal, towards_lights[i], light_places[i]);
  } while (++i < LIGHT_COUNT);
  return sum;
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.frame_size)))) return;
  PixelRelief here = pixel_relief(pixel);
  if (here.height < 0) return;
#if FLAT_BASES
  if (bases_of_instances[pixel_instance(pixel)] != no_instance) return;
#endif
  vec3 albedo = pixel_albedo(pixel);
  if (albedo == vec3(0.0)) return;
  vec3 sender = sender_albedo(pixel, albedo);
  find_lights(pixel, here.frame);
  BumpTexels texels = bump_texels(here.height);
  ReliefField field = texels.field;
  bool clamped = field.clamped != 0u;
  vec2 place = relief_place(here.uv, field.size);
#if BETWEEN
  float footprint = exp2(here.level);
#else
  const float footprint = 0.0;
#endif
  vec3 sum = vec3(0.0);
  float weights = 0.0;
  int i = 0;
  do {
    uint texel = nearest_texel(field.size, clamped, footprint_place(place, footprint, i, paths));
    BouncePath path = bounce_path(texels, texel, i);
    weights += path.weight;
    vec3 weight = vec3(path.weight);
    int number = i;
    for (int bounce = 0; bounce < bounces && path.texel != bounce_sky && path.weight > 0.0; ++bounce) {
      if (bounce > 0) weight *= sender * path.weight;
      sum += weight * texel_irradiance(texels, path.texel);
      if (bounce + 1 == bounces) break;
      number = bounce_next_path(number, path.texel, paths);
      path = bounce_path(texels, path.texel, number);
    }
  } while (++i < paths);
  // Bumps are Lambertian, as what they send light to.
  vec3 light = weights > 0.0 ? sum * albedo * sender * (inverse_pi / weights) : vec3(0.0);
  if (light == vec3(0.0)) return;
  imageStore(radiance, pixel, imageLoad(radiance, pixel) + vec4(light, 0.0));
}
