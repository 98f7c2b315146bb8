// What a compute pass that answers `visibility` starts from: its bindings (shadow::addVisibilityPass fills them), the
// receiver of a pixel and the light of a layer.
#ifndef LIMN_VISIBILITY_GLSL
#define LIMN_VISIBILITY_GLSL
#include "glsl/blocks.glsl"
#include "glsl/gbuffer.glsl"
#include "glsl/light_view.glsl"
#include "glsl/shadow_view.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0) uniform sampler2D gbuffer_depth;
layout(binding = 2) uniform sampler2D gbuffer_geometric_normal;
layout(binding = 6) uniform usampler2D gbuffer_instance;
layout(binding = 8) uniform sampler2DArray shadow_depth;
layout(std430, binding = 0) readonly buffer Lights { Light lights[]; };
layout(std430, binding = 1) readonly buffer ShadowViews { ShadowView shadow_views[]; };
layout(std430, binding = 2) readonly buffer ShadowLights { ShadowLight shadow_lights[]; };
layout(std430, binding = 3) buffer ShadowCoverage { uint uncovered_pixels; };
uniform float bias;        // texel footprints
uniform float light_size;  // metres or radians; < 0: the scene's

// One pixel and one light.
struct VisibilityQuery {
  vec3 position;
  vec3 normal;  // geometric, unit, towards the camera
  LightView light;
  ShadowLight maps;
  bool masked;  // V = 1: nothing there, or the light is wholly behind the surface
};

// at: pixel and layer. The maps of layer l are shadow_lights[l * samples + sample].
VisibilityQuery visibility_query(ivec3 at, int samples, int shadow_sample) {
  VisibilityQuery q;
  q.maps = shadow_lights[at.z * samples + shadow_sample];
  float depth = texelFetch(gbuffer_depth, at.xy, 0).r;
  vec3 ray = frame.view_ray_origin.xyz + float(at.x) * frame.view_ray_dx.xyz + float(at.y) * frame.view_ray_dy.xyz;
  q.position = frame.camera_position.xyz + depth * ray;
  q.normal = octahedral_decode(texelFetch(gbuffer_geometric_normal, at.xy, 0).rg);
  Light light = lights[q.maps.info.z];
  q.light = light_view(light, q.position, q.normal, light_size);
  bool itself = light.info.z != no_instance && texelFetch(gbuffer_instance, at.xy, 0).r == light.info.z;
  q.masked = depth == 0.0 || itself || q.light.masked;
  return q;
}

// One texel of a shadow map against the receiver.
struct ShadowTap {
  bool covered;  // some view sees the point asked for
  bool blocked;
  float depth;   // of what the map holds, from the light along its axis, metres
};

// The texel that holds the direction of world point p.
ShadowTap shadow_tap(VisibilityQuery q, vec3 p) {
  ShadowTap tap;
  uint layer = q.maps.info.x + shadow_face(q.maps.info.y, shadow_views[q.maps.info.x], p);
  ShadowView view = shadow_views[layer];
  ShadowPoint at = shadow_project(view, p);
  tap.covered = shadow_inside(at);
  tap.blocked = false;
  tap.depth = 0.0;
  if (!tap.covered) return tap;
  float size = float(view.info.z);
  ivec2 texel = min(ivec2(at.uv * size), ivec2(view.info.z) - 1);
  float stored = texelFetch(shadow_depth, ivec3(texel, layer), 0).r;
  if (stored >= 1.0) return tap;
  vec3 b = shadow_unproject_local(view, (vec2(texel) + 0.5) / size, shadow_metres(view, stored));
  ShadowReceiver receiver = shadow_receiver(view, q.position, q.normal, q.light.axis, bias);
  tap.blocked = shadow_blocks(receiver, b);
  tap.depth = q.light.depth - receiver.axis.w + dot(receiver.axis.xyz, b);
  return tap;
}

// The four texels around the direction of p, weighted bilinearly: the lit share.
float shadow_tap_2x2(VisibilityQuery q, vec3 p) {
  uint layer = q.maps.info.x + shadow_face(q.maps.info.y, shadow_views[q.maps.info.x], p);
  ShadowView view = shadow_views[layer];
  ShadowPoint at = shadow_project(view, p);
  if (!shadow_inside(at)) return 1.0;
  float size = float(view.info.z);
  vec2 corner = at.uv * size - 0.5;
  vec2 weight = fract(corner);
  ShadowReceiver receiver = shadow_receiver(view, q.position, q.normal, q.light.axis, bias);
  float lit = 0.0;
  for (int i = 0; i < 4; ++i) {
    ivec2 step = ivec2(i & 1, i >> 1);
    ivec2 texel = clamp(ivec2(floor(corner)) + step, ivec2(0), ivec2(view.info.z) - 1);
    float stored = texelFetch(shadow_depth, ivec3(texel, layer), 0).r;
    vec3 b = shadow_unproject_local(view, (vec2(texel) + 0.5) / size, shadow_metres(view, stored));
    vec2 w = mix(1.0 - weight, weight, vec2(step));
    if (stored >= 1.0 || !shadow_blocks(receiver, b)) lit += w.x * w.y;
  }
  return lit;
}

// Pixels whose receiver no map of the light covers have V = 1 and are counted.
bool shadow_covers_receiver(VisibilityQuery q) {
  uint layer = q.maps.info.x + shadow_face(q.maps.info.y, shadow_views[q.maps.info.x], q.position);
  if (shadow_inside(shadow_project(shadow_views[layer], q.position))) return true;
  atomicAdd(uncovered_pixels, 1u);
  return false;
}

#endif  // LIMN_VISIBILITY_GLSL
