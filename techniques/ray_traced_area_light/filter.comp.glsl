// V without the noise of few rays: the mean over neighbours on the same surface, and of what a pixel differs from it as much as
// the noise does not explain (Lee 1980, with the variance of the rays of each pixel as that of the noise).
//
// FRAMES: more than 1 where V is a sum over frames, r / a.
#include "glsl/scene/light.glsl"
#include "glsl/surface/gbuffer_input.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std430) readonly buffer Lights { Light lights[]; };
layout(r16) writeonly uniform image2DArray visibility;
uniform sampler2DArray traced;
#if FRAMES > 1
uniform sampler2DArray this_frame;  // r / a, too
#endif
uniform uint light_indices[LIGHT_COUNT];
uniform int rays;

const int reach = 3;  // pixels: the wavelengths of the shifts' blue noise lie within

struct Traced {
  float v;
  float rays;
};

Traced traced_at(ivec3 at) {
  vec4 sum = texelFetch(traced, at, 0);
#if FRAMES > 1
  return sum.a > 0.0 ? Traced(sum.r / sum.a, sum.a * float(rays)) : Traced(1.0, float(rays));
#else
  return Traced(sum.r, float(rays));
#endif
}

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID);
  if (any(greaterThanEqual(at, imageSize(visibility)))) return;
  Traced own = traced_at(at);
  float here = own.v;
  float depth = pixel_depth(at.xy);
  if (depth == 0.0 || !light_has_extent(lights[light_indices[at.z]])) {
    // One ray is exact: that of this frame.
#if FRAMES > 1
    vec4 now = texelFetch(this_frame, at, 0);
    here = now.a > 0.0 ? now.r / now.a : 1.0;
#endif
    imageStore(visibility, at, vec4(here));
    return;
  }
  vec3 position = pixel_position(at.xy, depth);
  vec3 normal = pixel_geometric_normal(at.xy);
  float footprint = depth * length(frame.view_ray_dx.xyz);
  float weights = 0.0, sum = 0.0, squares = 0.0, within = 0.0;
  for (int y = -reach; y <= reach; ++y) {
    for (int x = -reach; x <= reach; ++x) {
      ivec2 pixel = clamp(at.xy + ivec2(x, y), ivec2(0), imageSize(visibility).xy - 1);
      Traced neighbour = traced_at(ivec3(pixel, at.z));
      float v = neighbour.v;
      float d = pixel_depth(pixel);
      float height = abs(dot(normal, pixel_position(pixel, d) - position));
      float w = d > 0.0 && height <= footprint ? exp(-0.125 * float(x * x + y * y)) : 0.0;
      weights += w;
      sum += w * v;
      squares += w * v * v;
      within += w * v * (1.0 - v) / max(neighbour.rays - 1.0, 1.0);
    }
  }
  float mean = sum / weights;  // the pixel itself has a weight
  float spread = max(squares / weights - mean * mean, 0.0);
  // One ray does not say how much it may be off: all that differs is noise then.
  float noise = own.rays > 1.0 ? within / weights : spread;
  imageStore(visibility, at, vec4(mean + (here - mean) * max(spread - noise, 0.0) / max(spread, 1e-6)));
}
