// Spreads the light of translucent pixels along rows (ROWS 1), or along columns and lets it out (0). TANGENT 1: taps lie on the
// plane that touches the surface; 0: on one that faces the camera. FOLLOW 1: those that are not near it in depth count as
// missing, as those of other instances and outside the picture do. CENTRE 1: in place of what is missing stands the light of
// the pixel itself; 0: the mean of what is there.
#include "glsl/diffusion/pixel_exit.glsl"
#include "techniques/separable_subsurface/line_footprint.glsl"
#include "techniques/separable_subsurface/line_pixel.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
#ifdef LINE_TAP_COUNT
layout(std140) uniform LineTaps { LineTap line_taps[LINE_TAP_COUNT]; };
#else
layout(std430) readonly buffer LineTaps { LineTap line_taps[]; };
#endif
uniform sampler2D entered;  // rgb: light, over pi; a: depth of the pixel; undefined at pixels that have not been spread
#if ROWS
layout(rgba32f) writeonly uniform image2D spread;
#else
layout(rgba32f) uniform image2D radiance;
#endif

const ivec2 line_step = ROWS != 0 ? ivec2(1, 0) : ivec2(0, 1);

struct LinePixel {
  ivec2 pixel;
  uint instance;
  vec3 light;
  float depth;
  LineFootprint footprint;
  float limits;  // 1 / depth_limit
};

// rgb: light of a tap; a: how much of it is there, 0 to 1.
vec4 light_of_tap(LinePixel p, float offset) {
  float size = float(ROWS != 0 ? frame.frame_size.x : frame.frame_size.y);
  float start = float(ROWS != 0 ? p.pixel.x : p.pixel.y);
  float depth = footprint_depth(p.footprint, offset);
  float place = floor(start + 0.5 + footprint_shift(p.footprint, offset, max(depth, 1e-6)));
  bool seen = depth > 0.0 && place >= 0.0 && place < size;
  ivec2 pixel = p.pixel + line_step * int(clamp(place, 0.0, size - 1.0) - start);
  bool kept = seen && pixel_instance(pixel) == p.instance;
  vec4 there = texelFetch(entered, pixel, 0);
  float part = 1.0;
#if FOLLOW
  part = clamp(1.0 - p.limits * abs(there.w - depth * p.depth), 0.0, 1.0);
#endif
  return kept ? vec4(there.rgb, part) : vec4(0.0);
}

vec3 spread_light(LinePixel p, uint first) {
  vec3 there = max(line_taps[first].weight, vec3(1e-20));
  vec3 sum = there * p.light;
  for (int i = 1; i <= SIDE_TAPS; ++i) {
    LineTap tap = line_taps[first + uint(i)];
    vec4 back = light_of_tap(p, -tap.offset);
    vec4 ahead = light_of_tap(p, tap.offset);
    sum += tap.weight * (back.a * back.rgb + ahead.a * ahead.rgb);
    there += tap.weight * (back.a + ahead.a);
  }
#if CENTRE
  return sum + max(1.0 - there, 0.0) * p.light;
#else
  return sum / there;
#endif
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.frame_size)))) return;
  LinePixel p;
  p.pixel = pixel;
  p.instance = pixel_instance(pixel);
  uint row = line_material_of(p.instance);
  if (row == no_line_material) return;
  LineMaterial material = line_materials[row];
  vec4 here = texelFetch(entered, pixel, 0);
  p.light = here.rgb;
  p.depth = here.w;
  float width = width_over_taps(material, pixel);
  p.limits = 1.0 / max(width * material.depth_limit, 1e-30);
  vec3 ray_step = ROWS != 0 ? frame.view_ray_dx.xyz : frame.view_ray_dy.xyz;
#if TANGENT
  p.footprint = tangent_footprint(pixel_geometric_normal(pixel), pixel_ray(pixel), ray_step, p.depth);
#else
  p.footprint = facing_footprint(ray_step, p.depth);
#endif
  p.footprint.pixels *= width;
  p.footprint.receding *= width;
  vec3 light = spread_light(p, material.first_tap);
#if ROWS
  imageStore(spread, pixel, vec4(light, p.depth));
#else
  DiffusionBoundary boundary = diffusion_boundary(material.eta, material.entering);
  vec3 leaving = light * root_reflectance(material, pixel) * pixel_exit(pixel, boundary);
  imageStore(radiance, pixel, imageLoad(radiance, pixel) + vec4(leaving, 0.0));
#endif
}
