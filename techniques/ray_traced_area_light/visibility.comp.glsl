// V as the share of a light's points that shadow rays reach: the points of the R2 sequence, shifted on the torus by blue noise.
//
// FRAMES: frame i sends its rays to set i % FRAMES of as many sets of points, which follow each other in the sequence. TRACED:
// format of the result; of four channels rgb / a is V, and a is 0 where nothing is seen.
#include "glsl/light/light_view.glsl"
#include "glsl/numeric/sampling.glsl"
#include "glsl/rays/ray_trace.glsl"
#include "glsl/surface/gbuffer_input.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std430) readonly buffer Lights { Light lights[]; };
layout(TRACED) writeonly uniform image2DArray visibility;
uniform sampler2D blue_noise;
uniform uint light_indices[LIGHT_COUNT];
uniform int rays;

// GPUs snap vertices to a 256th of a pixel, so that a pixel's depth is known to some 2e-5 of it, along a floor seen flatly to ten
// times as much.
const float snapping_reach = 2.44140625e-4;       // 2^-12
const float snapping_clearance = 6.103515625e-5;  // 2^-14
// What coordinates round by, of the largest. Before a rectangle, of which no depth was drawn, rays end by this. A lamp without
// extent may be mounted on a surface, which rounding puts on either side of it, the more so the flatter rays meet it: before that
// they end by 16 times as much, as the reference's do.
const float rounding_clearance = 9.5367431640625e-7;  // 2^-20
const float unlimited = 3.0e38;

float largest(vec3 v) { return max(max(abs(v.x), abs(v.y)), abs(v.z)); }

// Where rays from a pixel's surface start, clear of it. A ray from the camera finds the triangle that snapping moved, so that
// rounding is all that is to be cleared: small triangles shadow each other where rays graze them, and starting above them would
// lose that. At edges that only the drawn triangle covers the depth has to do.
vec3 ray_start(vec3 position, vec3 normal) {
  vec3 way = position - frame.camera_position.xyz;
  vec3 before = position - snapping_reach * way, segment = 2.0 * snapping_reach * way;
  float clearance = max(snapping_clearance * length(way), rounding_clearance * largest(position));
  float at = 1.0;
  if (!ray_nearest(before, segment, at, no_instance)) return position + clearance * normal;
  float rounding = rounding_clearance * max(largest(position), frame.scene_radius);
  return before + at * segment + min(clearance, rounding) * normal;
}

// What the rays of a pixel towards one light have in common.
struct ShadowRays {
  vec3 position;
  vec3 origin;     // clear of the receiver
  vec3 clearance;  // from a point of the light to where its ray ends
  bool finite;
  float depth;  // of the receiver, m: what slopes are multiples of; 1 for directions
  uint itself;  // instance that the light is
};

bool blocked(ShadowRays r, vec3 slope) {
  if (!r.finite) return ray_occluded(r.origin, slope, unlimited, r.itself);
  vec3 target = r.position + r.depth * slope + r.clearance;
  return ray_occluded(r.origin, target - r.origin, 1.0, r.itself);
}

float lit_share(LightView view, ShadowRays r, vec2 shift) {
  if (!view.extended) return blocked(r, view.centre) ? 0.0 : 1.0;
  int lit = 0, sent = 0;
  // Of the box around the part of a rectangle above the horizon at least half is that part, of a disc's square maybe next to
  // nothing: where all tries miss it, one ray goes to its highest point.
  int most = view.whole ? rays : 4 * rays;
  uint first = FRAMES > 1 ? frame.frame_index % uint(FRAMES) * uint(most) : 0u;
  for (int i = 0; i <= most && sent < rays; ++i) {
    vec2 u = fract(r2_sequence(first + uint(i)) + shift);
    vec3 slope = view.centre;
    if (view.whole) {
      slope = light_view_point(view, u);
    } else if (i == most) {
      slope = light_view_highest(view);
      if (sent > 0 || dot(slope, view.normal) <= 0.0) break;
    } else if (!light_view_sample(view, u, slope)) {
      continue;
    }
    ++sent;
    if (!blocked(r, slope)) ++lit;
  }
  return sent == 0 ? 1.0 : float(lit) / float(sent);
}

// What V is weighted by for frames after this one (core/history/frame_history.h). Rays to lights with extent are a part of all
// that a frame sends to a place: as camera or surface move, the place comes to a pixel with another shift. That V differs there is
// noise, and no light that changed.
float share_of_frame() {
#if FRAMES > 1
  for (int i = 0; i < LIGHT_COUNT; ++i)
    if (light_has_extent(lights[light_indices[i]])) return 0.5;
#endif
  return 1.0;
}

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID);
  if (any(greaterThanEqual(at, imageSize(visibility)))) return;
  Light light = lights[light_indices[at.z]];
  float v = 1.0;
  float depth = pixel_depth(at.xy);
  bool itself = pixel_shows_light(at.xy, light);
  if (depth > 0.0 && !itself) {
    vec3 position = pixel_position(at.xy, depth);
    vec3 normal = pixel_geometric_normal(at.xy);
    LightView view = light_view(light, position, normal, -1.0);
    if (!view.masked) {
      ShadowRays r;
      r.position = position;
      r.origin = ray_start(position, normal);
      r.finite = light.type != light_directional;
      r.depth = r.finite ? view.depth : 1.0;
      r.itself = light.own_instance;
      r.clearance = vec3(0.0);
      if (light.type == light_rectangle) {
        float reach = largest(abs(light.position) + abs(light.axis_u) * light.length_u + abs(light.axis_v) * light.length_v);
        r.clearance = light.direction * (rounding_clearance * reach * rectangle_side(light, position));
      } else if (r.finite) {
        float clearance = 16.0 * rounding_clearance * max(largest(light.position), view.depth);
        r.clearance = view.axis * min(clearance, 0.5 * view.depth);
      }
      v = lit_share(view, r, texelFetch(blue_noise, at.xy % textureSize(blue_noise, 0), 0).xy);
    }
  }
  imageStore(visibility, at, share_of_frame() * vec4(vec3(v), depth > 0.0 ? 1.0 : 0.0));
}
