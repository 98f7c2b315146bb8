// What fragment shaders of caustic lines share: where on its ray a fragment lies, what hides it, and its weight. KIND and
// BEAMS: see lines.vert.glsl.
#ifndef LIMN_LINE_FRAGMENT_GLSL
#define LIMN_LINE_FRAGMENT_GLSL
#include "glsl/caustic_line.glsl"
#include "glsl/caustic_ray.glsl"
#include "glsl/medium_input.glsl"

layout(location = 0) flat in int ray_index;
layout(location = 1) flat in vec3 line_origin;
layout(location = 2) flat in vec3 line_direction;
layout(location = 3) flat in vec2 line_axis;
layout(location = 4) flat in vec3 line_range;
layout(location = 5) in vec2 line_width;

layout(binding = 0) uniform sampler2D gbuffer_depth;
layout(std430, binding = 0) readonly buffer Rays { CausticRay rays[]; };
layout(std430, binding = 1) readonly buffer LineRule { uint line_fragments; };

layout(location = 0) out vec4 radiance;

struct LineFragment {
  float along;    // metres from the start of the ray
  vec3 place;     // camera space
  bool hidden;
};

LineFragment line_fragment() {
  LineFragment f;
  vec2 metres = vec2(length(frame.view_ray_dx.xyz), length(frame.view_ray_dy.xyz));
  vec2 slope = (gl_FragCoord.xy - 0.5 * vec2(frame.frame_size.xy)) * metres;
#if KIND == 1
  f.along = 0.5 * (line_range.x + line_range.y);
#else
  f.along = clamp(caustic_line_position(line_origin, line_direction, line_axis, slope), line_range.x, line_range.y);
#endif
  f.place = line_origin + f.along * line_direction;
  float depth = texelFetch(gbuffer_depth, ivec2(gl_FragCoord.xy), 0).x;
  f.hidden = depth > 0.0 && f.place.z > depth;
  return f;
}

// Radiance per (flux * sigma_s * p * transmittances), 1/m.
float line_weight(LineFragment f) {
  float focal = 1.0 / length(frame.view_ray_dx.xyz);
#if KIND == 1
  return line_range.z;
#else
  vec2 rate = abs(caustic_line_rate(f.place, line_direction));
#if KIND == 0
  bool rectangles = line_fragments > 850u;
  return caustic_line_weight(f.place, rectangles ? length(rate) : max(rate.x, rate.y), focal);
#else
  return caustic_line_weight(f.place, length(rate), focal) * line_width.y / line_width.x;
#endif
#endif
}

#endif  // LIMN_LINE_FRAGMENT_GLSL
