// The map that a virtual light has of its own: its paraboloid view, and one receiver against one texel of it, for loops over
// lights. All that such maps have in common is known beforehand, so that nothing of a view is loaded: its axes follow from
// the light's normal. The same answers as glsl/shadow/shadow_view.glsl gives for light_map_view().
#ifndef LIMN_LIGHT_MAP_GLSL
#define LIMN_LIGHT_MAP_GLSL
#include "glsl/numeric/language.glsl"
#include "glsl/shadow/paraboloid.glsl"
#include "glsl/indirect/virtual_light.glsl"
LIMN_BEGIN

// What all maps of a scene's virtual lights share.
struct LightMaps {
  float lift;   // of a view's origin over its light's surface, m: a hair, so that the surface's own plane lies behind it
  float near;   // m
  float depth;  // far - near, m
  float texels;
};

// extent: diagonal of the scene's bounds, m.
LIMN_FN LightMaps light_maps(float extent, uint texels) {
  LightMaps maps;
  maps.lift = 1e-4f * extent;
  maps.near = 1e-4f * extent;
  maps.depth = (1.001f - 1e-4f) * extent;
  maps.texels = float(texels);
  return maps;
}

// A light without flux looks out of the scene: nothing is drawn for it.
LIMN_FN ShadowView light_map_view(VirtualPointLight light, LightMaps maps, uint layer) {
  vec3 normal = light.normal;
  float lift = virtual_light_shines(light) ? maps.lift : 1e7f * maps.lift;
  return paraboloid_view(light.position + lift * normal, normal, maps.near, maps.near + maps.depth, layer,
                         uint(maps.texels));
}

// The axes of a view around a normal: those of frame_around(), of which y is turned.
struct LightMapAxes {
  vec3 normal;
  float side;    // 1 or -1: of normal.z
  float shrink;  // -1 / (side + normal.z)
};

LIMN_FN LightMapAxes light_map_axes(vec3 normal) {
  LightMapAxes axes;
  axes.normal = normal;
  axes.side = normal.z >= 0.0f ? 1.0f : -1.0f;
  axes.shrink = -1.0f / (axes.side + normal.z);
  return axes;
}

// x and y of a vector of the world along them; z is dot(normal, v).
LIMN_FN vec2 light_map_across(LightMapAxes axes, vec3 v) {
  float k = axes.shrink * (axes.normal.x * v.x + axes.normal.y * v.y) - v.z;
  return vec2(v.x + axes.side * axes.normal.x * k, -axes.side * v.y - axes.normal.y * k);
}

// A receiver in a map.
struct LightMapPlace {
  vec3 local;     // from the view's origin, in its axes, m
  float d2;       // square of its distance
  vec2 texel;     // number of the texel that shows it
  bool inside;    // the map
};

// from: from the light to the receiver, m; height: dot(normal, from) > 0.
LIMN_FN LightMapPlace light_map_place(LightMaps maps, LightMapAxes axes, vec3 from, float height) {
  LightMapPlace place;
  vec2 across = light_map_across(axes, from);
  float z = height - maps.lift;
  place.local = vec3(across.x, across.y, z);
  place.d2 = dot(across, across) + z * z;
  float half_texels = 0.5f * maps.texels;
  float k = half_texels / (sqrt(place.d2) + z);
  place.texel = floor(vec2(half_texels) + k * across);
  place.inside = max(abs(place.texel.x + 0.5f - half_texels), abs(place.texel.y + 0.5f - half_texels)) < half_texels;
  return place;
}

// shadow_blocks() of what the place's texel shows at the depth `stored`. normal: the receiver's geometric normal; height: of
// the receiver over the light along it, m; raise: bias in metres per metre of distance.
LIMN_FN bool light_map_blocks(LightMaps maps, LightMapAxes axes, LightMapPlace place, float stored, vec3 normal,
                              float height, float raise) {
  vec2 across = light_map_across(axes, normal);
  float upright = dot(axes.normal, normal);
  float per_texel = 2.0f / maps.texels;
  vec2 p = per_texel * (place.texel + vec2(0.5f)) - vec2(1.0f);
  float rho2 = dot(p, p);
  // The direction through the texel's centre is (2 p, 1 - rho2) / (1 + rho2): both sides are multiplied by the divisor.
  float depth = maps.near + stored * maps.depth;
  float rise = 2.0f * dot(across, p) + upright * (1.0f - rho2);
  float along = 2.0f * (place.local.x * p.x + place.local.y * p.y) + place.local.z * (1.0f - rho2);
  float above = height - maps.lift * upright + raise * sqrt(place.d2);
  return stored < 1.0f && depth * rise > above * (1.0f + rho2) && depth * along < place.d2 * (1.0f + rho2);
}

LIMN_END
#endif  // LIMN_LIGHT_MAP_GLSL
