// Splats the discs of some points into each map: the nearest depth of every texel whose centre a disc covers. Each map has
// its own points, which follow each other in the pool.
#include "glsl/shadow/paraboloid.glsl"
#include "glsl/indirect/scene_point.glsl"

layout(local_size_x = 64) in;
layout(std430) readonly buffer Placed { PlacedPoint placed[]; };
layout(std430) readonly buffer Views { ShadowView views[]; };
layout(std430) buffer Depths { uint depths[]; };  // bits of stored depths, map by map
uniform uint first;   // view of the first map
uniform uint points;  // per map
uniform uint pool;
uniform float radius;  // of a disc, m
uniform float reach;   // radius of the largest splat, texels

// Distance to the plane of the disc along `direction`, no farther from the centre's than the disc is wide.
float disc_depth(vec3 centre, vec3 normal, vec3 direction) {
  float depth = length(centre);
  float slant = dot(normal, direction);
  float hit = dot(normal, centre) / (abs(slant) > 1e-6 ? slant : 1e-6);
  return clamp(hit, depth - radius, depth + radius);
}

void main() {
  uint k = gl_GlobalInvocationID.x;
  uint map = gl_GlobalInvocationID.y;
  if (k >= points) return;
  ShadowView view = views[first + map];
  PlacedPoint point = placed[((first + map) * points + k) % pool];
  vec3 centre = shadow_local(view, point.position.xyz);
  float depth = length(centre);
  if (!(centre.z > 0.0 && depth > view.near && depth < view.far)) return;

  vec3 normal = shadow_view_axes(view, point.normal.xyz);
  vec2 disc = paraboloid_map(centre / depth);
  int side = int(view.size);
  vec2 at = (0.5 + 0.5 * disc) * float(side);
  float facing = sqrt(abs(dot(normal, centre)) / depth);  // of a circle of the disc's solid angle
  float texels = min(facing * radius / depth * paraboloid_scale(dot(disc, disc)) * 0.5 * float(side), reach);
  ivec2 low = clamp(ivec2(floor(at - texels)), ivec2(0), ivec2(side - 1));
  ivec2 high = clamp(ivec2(floor(at + texels)), ivec2(0), ivec2(side - 1));
  ivec2 own = clamp(ivec2(at), ivec2(0), ivec2(side - 1));
  for (int y = low.y; y <= high.y; ++y) {
    for (int x = low.x; x <= high.x; ++x) {
      vec2 texel = vec2(x, y) + 0.5;
      vec2 from = texel - at;
      if (dot(from, from) > texels * texels && ivec2(x, y) != own) continue;
      vec3 direction = paraboloid_direction(2.0 * texel / float(side) - 1.0);
      float stored = shadow_normalise(view, disc_depth(centre, normal, direction));
      // Bits of floats that are not negative have the order of the floats.
      atomicMin(depths[(map * uint(side) + uint(y)) * uint(side) + uint(x)], floatBitsToUint(clamp(stored, 0.0, 1.0)));
    }
  }
}
