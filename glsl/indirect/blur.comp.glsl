// One direction of the geometry-aware blur: pixels `stride` apart, of which those count that lie near the pixel, near its
// tangent plane, and face the same way (Laine et al. 2007, Incremental Instant Radiosity for Real-Time Indirect
// Illumination, without the plane). Sums of values and of weights go on undivided.
//
// The weights are a tent of `width` pixels to either side, so that each place in a pattern of `width` interleaved pixels
// counts once: 1 - t / width at t, and t / width at t - width. Where one of these two does not count, the other does in
// full.
//
// FOLD 1: the residual goes to the diffuse part, as far as the pattern's places count. A pixel is thus lit as with a bound of the
// inverse square that falls with the root of the number of lights of which it is the mean: 1 / bound^2 is linear in it.
//
// COLOURS 1: the specular part is per unit of specular reflectance (GATHER_COLOURLESS), by which it is multiplied here.
//
// PARTS: number of the parts that are blurred; the result holds no others. FIRST_LAYER: layer of `gathered` that holds the first of
// them. VERTICAL 1: along columns.
#include "glsl/surface/gbuffer_input.glsl"
#include "glsl/surface/reflectance.glsl"
#include "glsl/indirect/gather_parts.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
uniform sampler2DArray gathered;
layout(rgba32f) writeonly uniform image2DArray blurred;
uniform int width;
uniform int stride;
uniform float position_threshold;  // part of the scene's extent
uniform float plane_threshold;     // the same
uniform float normal_threshold;    // least cosine

struct Centre {
  vec3 position;
  vec3 normal;
  float reach;      // m
  float thickness;  // m
};

vec3 normal_at(ivec2 pixel) { return octahedral_decode(texelFetch(gbuffer_normal, pixel, 0).xy); }

bool counts(Centre c, ivec2 pixel) {
  if (any(lessThan(pixel, ivec2(0))) || any(greaterThanEqual(pixel, ivec2(frame.frame_size)))) return false;
  float depth = pixel_depth(pixel);
  vec3 offset = pixel_position(pixel, depth) - c.position;
  return depth > 0.0 && dot(offset, offset) <= c.reach * c.reach && abs(dot(offset, c.normal)) <= c.thickness &&
         dot(normal_at(pixel), c.normal) >= normal_threshold;
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.frame_size)))) return;
  float depth = pixel_depth(pixel);
  Centre centre = Centre(pixel_position(pixel, depth), normal_at(pixel), position_threshold * gather_extent(),
                         plane_threshold * gather_extent());
  vec4 sums[PARTS];
  for (int part = 0; part < PARTS; ++part) sums[part] = vec4(0.0);
#if VERTICAL
  ivec2 axis = ivec2(0, stride);
#else
  ivec2 axis = ivec2(stride, 0);
#endif
  for (int t = 0; depth > 0.0 && t < width; ++t) {
    ivec2 after = pixel + t * axis;
    ivec2 before = after - width * axis;
    float share = float(t) / float(width);
    vec2 weight = vec2(1.0 - share, share);
    if (t > 0) {
      bool one = counts(centre, after);
      bool other = counts(centre, before);
      if (one != other) weight = one ? vec2(1.0, 0.0) : vec2(0.0, 1.0);
      if (!one && !other) continue;
    }
    for (int part = 0; part < PARTS; ++part) {
      vec4 sum = vec4(0.0);
      if (weight.x > 0.0) sum = weight.x * texelFetch(gathered, ivec3(after, FIRST_LAYER + part), 0);
      if (weight.y > 0.0) sum += weight.y * texelFetch(gathered, ivec3(before, FIRST_LAYER + part), 0);
      sums[part] += sum;
    }
  }
#if FOLD
  sums[gather_part_diffuse].rgb += sums[gather_part_diffuse].a / float(width) * sums[gather_part_residual].rgb;
#endif
#if COLOURS
  GBufferSurface surface = pixel_surface(pixel);
  sums[gather_part_specular].rgb *= specular_reflectance(surface_brdf(surface.base_colour, surface.metallic, surface.roughness,
                                                                      surface.specular_factor, surface.specular_colour,
                                                                      surface.ior));
#endif
  for (int part = 0; part < PARTS - FOLD; ++part) imageStore(blurred, ivec3(pixel, part), sums[part] / float(width));
}
