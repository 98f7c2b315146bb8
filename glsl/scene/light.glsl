// One light as the GPU, the reference and the shadow techniques all see it, in world space (metres, right-handed).
#ifndef LIMN_LIGHT_GLSL
#define LIMN_LIGHT_GLSL
#include "glsl/numeric/language.glsl"
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
  vec3 position;  // centre
  uint unused;
  vec3 direction;          // unit vector the light looks along (propagation); the rectangle's face normal
  float texture_number;    // of the texture that a spot shines through, from 1 on, or 0
  vec3 axis_u;             // unit vector along the rectangle's first side
  float length_u;          // of that side, metres (0: none)
  vec3 axis_v;             // unit vector along the second side; cross(axis_u, axis_v) = -direction, or the normal of a
                           // distant rectangle's plane, away from receivers
  float length_v;          // of that side, metres
  vec3 emission;           // rgb, unit by type above
  float solid_angle;       // of a distant rectangle, sr
  float cos_inner;         // cosines of the cone's angles
  float cos_outer;
  float range;             // metres (0: unlimited)
  float angular_diameter;  // of a directional light, radians
  uint type;               // light_point, ...
  uint flags;              // light_flag_*
  uint own_instance;       // draw instance to skip in its own shadow map, or no_instance
  uint index;              // in the scene
};

LIMN_FN bool light_is_distant_rectangle(Light light) {
  return light.type == light_directional && light.length_u > 0.0f;
}

// Whether a draw instance is the light's own surface. A flat light does not see itself; rounding must not decide on which
// side of itself its places lie.
LIMN_FN bool light_is_instance(Light light, uint instance) {
  return light.own_instance != no_instance && light.own_instance == instance;
}

// What a light's points are, as seen from a receiver.
LIMN_CONST uint light_kind_point = 0u;              // one point, or a square of a given size that stands for it
LIMN_CONST uint light_kind_disc = 1u;               // directions within a cone
LIMN_CONST uint light_kind_distant_rectangle = 2u;  // directions to a rectangle
LIMN_CONST uint light_kind_rectangle = 3u;          // points of a rectangle

LIMN_FN uint light_kind(Light light) {
  if (light.type == light_rectangle) return light_kind_rectangle;
  if (light.type != light_directional) return light_kind_point;
  return light_is_distant_rectangle(light) ? light_kind_distant_rectangle : light_kind_disc;
}

// Whether points on the light differ: rectangles, and directional lights with an angular diameter or sides.
LIMN_FN bool light_has_extent(Light light) {
  return light.type == light_rectangle || light_is_distant_rectangle(light) ||
         (light.type == light_directional && light.angular_diameter > 0.0f);
}

// Of a rectangle, distant or not, W/(sr m^2).
LIMN_FN vec3 rectangle_radiance(Light light) {
  return light.type == light_directional ? light.emission / light.solid_angle : light.emission;
}

// Width of a spot's ramp in the cosine, at least what floats near 1 tell apart: that of a cone of 0.1 degrees is 1.5e-6.
LIMN_FN float spot_ramp(Light light) { return max(light.cos_inner - light.cos_outer, 1e-6f); }

// Cone factor at a receiver in direction w (unit, from the light's centre): a factor at the receiver, in both
// renderers (KHR_lights_punctual: squared linear ramp in the cosine between the outer and the inner angle).
LIMN_FN float spot_cone_factor(Light light, vec3 w) {
  if ((light.flags & light_flag_cone) == 0u) return 1.0f;
  float t = clamp((dot(light.direction, w) - light.cos_outer) / spot_ramp(light), 0.0f, 1.0f);
  return t * t;
}

// Where on a spot's texture the light passes that goes to p: (0, 0) is its lower left and (1, 1) its upper right corner as
// the light sees it. It fills the square around the outer cone (of up to 89 degrees); outside is outside the cone.
LIMN_FN vec2 light_texture_place(Light light, vec3 p) {
  vec3 offset = p - light.position;
  float cosine = max(light.cos_outer, 0.0175f);
  float tangent = sqrt(max(1.0f - cosine * cosine, 1e-12f)) / cosine;
  float side = 2.0f * tangent * max(dot(light.direction, offset), 1e-30f);
  return vec2(dot(light.axis_u, offset), dot(light.axis_v, offset)) / side + 0.5f;
}

// Range window at `distance` metres from the light's centre (KHR_lights_punctual; 1 without a range). The inverse
// square is not part of it.
LIMN_FN float range_factor(Light light, float distance) {
  if (!(light.range > 0.0f)) return 1.0f;
  float q = distance / light.range;
  return clamp(1.0f - q * q * q * q, 0.0f, 1.0f);
}

// What a receiver's place relative to the light's centre does to all light it gets from it: cone and range. 1 for
// directional lights. Multiplies the radiance of a rectangle, the intensity of a point or spot light.
LIMN_FN float receiver_factor(Light light, vec3 receiver) {
  if (light.type == light_directional) return 1.0f;
  vec3 offset = receiver - light.position;
  float distance = length(offset);
  if (!(distance > 0.0f)) return 0.0f;
  return spot_cone_factor(light, offset / distance) * range_factor(light, distance);
}

// Irradiance (W/m^2) on a surface that faces the centre of a point or spot light, or a directional light's direction
// of incidence, unoccluded.
LIMN_FN vec3 punctual_irradiance(Light light, vec3 receiver) {
  if (light.type == light_directional) return light.emission;
  vec3 offset = receiver - light.position;
  float distance2 = dot(offset, offset);
  return distance2 > 0.0f ? light.emission * (receiver_factor(light, receiver) / distance2) : vec3(0.0f);
}

LIMN_END
#endif
