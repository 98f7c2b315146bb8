// One light as the GPU, the reference and the shadow techniques all see it, in world space (metres, right-handed).
#ifndef LIMN_LIGHT_GLSL
#define LIMN_LIGHT_GLSL
#include "glsl/language.glsl"
LIMN_BEGIN

LIMN_CONST uint light_point = 0u;        // emission: radiant intensity, W/sr
LIMN_CONST uint light_spot = 1u;         // emission: radiant intensity on the axis, W/sr
LIMN_CONST uint light_directional = 2u;  // emission: irradiance on a perpendicular surface, W/m^2
LIMN_CONST uint light_rectangle = 3u;    // emission: radiance, W/(sr m^2)

LIMN_CONST uint light_flag_two_sided = 1u;  // rectangle that emits from both faces (doubleSided emissive quad)
LIMN_CONST uint light_flag_geometry = 2u;   // rectangle that is an emissive quad of the scene: visible, blocks others
LIMN_CONST uint light_flag_cone = 4u;       // spot cone applies (spot, or rectangle made from a spot)
LIMN_CONST uint light_flag_environment = 8u;  // stands for a part of the environment
LIMN_CONST uint light_flag_centre = 16u;      // distant rectangle: reflected as if all of it came from its centre
LIMN_CONST uint no_instance = 0xffffffffu;

// A directional light with sides is a distant rectangle: the directions to a rectangle in a plane at distance 1 from
// every receiver. Its position and sides are those of that rectangle.
struct Light {
  vec4 position;   // xyz: centre
  vec4 direction;  // xyz: unit vector the light looks along (propagation); the rectangle's face normal; w: number of the
                   // texture that a spot shines through, from 1 on, or 0
  vec4 axis_u;     // xyz: unit vector along the rectangle's first side; w: its length u in metres (0: none)
  vec4 axis_v;     // xyz: unit vector along the second side; w: its length v; cross(axis_u, axis_v) = -direction, or the
                   // normal of a distant rectangle's plane, away from receivers
  vec4 emission;   // rgb, unit by type above; w: solid angle of a distant rectangle, sr
  vec4 cone;       // x: cos of the inner, y: of the outer cone angle; z: range in metres (0: unlimited);
                   // w: angular diameter of a directional light, radians
  uvec4 info;      // x: type, y: flags, z: draw instance to skip in its own shadow map (or no_instance), w: index
};

LIMN_FN bool light_is_distant_rectangle(Light light) {
  return light.info.x == light_directional && light.axis_u.w > 0.0f;
}

// Whether points on the light differ: rectangles, and directional lights with an angular diameter or sides.
LIMN_FN bool light_has_extent(Light light) {
  return light.info.x == light_rectangle || light_is_distant_rectangle(light) ||
         (light.info.x == light_directional && light.cone.w > 0.0f);
}

// Of a rectangle, distant or not, W/(sr m^2).
LIMN_FN vec3 rectangle_radiance(Light light) {
  return light.info.x == light_directional ? vec3(light.emission) / light.emission.w : vec3(light.emission);
}

// Cone factor at a receiver in direction w (unit, from the light's centre): a factor at the receiver, in both
// renderers (KHR_lights_punctual: squared linear ramp in the cosine between the outer and the inner angle).
LIMN_FN float spot_cone_factor(Light light, vec3 w) {
  if ((light.info.y & light_flag_cone) == 0u) return 1.0f;
  float range = max(light.cone.x - light.cone.y, 1e-4f);
  float t = clamp((dot(vec3(light.direction), w) - light.cone.y) / range, 0.0f, 1.0f);
  return t * t;
}

// Where on a spot's texture the light passes that goes to p: (0, 0) is its lower left and (1, 1) its upper right corner as
// the light sees it. It fills the square around the outer cone (of up to 89 degrees); outside is outside the cone.
LIMN_FN vec2 light_texture_place(Light light, vec3 p) {
  vec3 offset = p - vec3(light.position);
  float cosine = max(light.cone.y, 0.0175f);
  float tangent = sqrt(max(1.0f - cosine * cosine, 1e-12f)) / cosine;
  float side = 2.0f * tangent * max(dot(vec3(light.direction), offset), 1e-30f);
  return vec2(dot(vec3(light.axis_u), offset), dot(vec3(light.axis_v), offset)) / side + 0.5f;
}

// Range window at `distance` metres from the light's centre (KHR_lights_punctual; 1 without a range). The inverse
// square is not part of it.
LIMN_FN float range_factor(Light light, float distance) {
  if (!(light.cone.z > 0.0f)) return 1.0f;
  float q = distance / light.cone.z;
  return clamp(1.0f - q * q * q * q, 0.0f, 1.0f);
}

// What a receiver's place relative to the light's centre does to all light it gets from it: cone and range. 1 for
// directional lights. Multiplies the radiance of a rectangle, the intensity of a point or spot light.
LIMN_FN float receiver_factor(Light light, vec3 receiver) {
  if (light.info.x == light_directional) return 1.0f;
  vec3 offset = receiver - vec3(light.position);
  float distance = length(offset);
  if (!(distance > 0.0f)) return 0.0f;
  return spot_cone_factor(light, offset / distance) * range_factor(light, distance);
}

// Irradiance (W/m^2) on a surface that faces the centre of a point or spot light, or a directional light's direction
// of incidence, unoccluded.
LIMN_FN vec3 punctual_irradiance(Light light, vec3 receiver) {
  if (light.info.x == light_directional) return vec3(light.emission);
  vec3 offset = receiver - vec3(light.position);
  float distance2 = dot(offset, offset);
  return distance2 > 0.0f ? vec3(light.emission) * (receiver_factor(light, receiver) / distance2) : vec3(0.0f);
}

LIMN_END
#endif
