// What fragment shaders of caustic lines share: where on its ray a fragment lies, how much of it is seen, its weight, and the main
// function, which asks the technique's scattered_at(). KIND and BEAMS: see lines.vert.glsl.
#ifndef LIMN_LINE_FRAGMENT_GLSL
#define LIMN_LINE_FRAGMENT_GLSL
#include "glsl/caustics/caustic_line.glsl"
#include "glsl/caustics/caustic_ray.glsl"
#include "glsl/media/medium_input.glsl"

layout(location = 0) flat in int ray_index;
layout(location = 1) flat in vec3 line_origin;
layout(location = 2) flat in vec3 line_direction;
layout(location = 3) flat in vec2 line_axis;
layout(location = 4) flat in vec3 line_range;
layout(location = 5) in vec3 line_width;

uniform sampler2D gbuffer_depth;
layout(std430) readonly buffer Rays { CausticRay rays[]; };

layout(location = 0) out vec4 radiance;

// Of a fragment, each of which is a LineFragment of its own. A point stands for a whole line, which may reach far in depth at one
// place of the picture.
#if KIND == 1
const int line_nodes = 8;
#else
const int line_nodes = 1;
#endif

struct LineFragment {
  float along;  // metres from the start of the ray
  vec3 place;   // camera space
  float share;  // of the piece that the nodes stand for: what belongs to the line, to this node, and is seen; 0: nothing
};

// Of the pixel's centre, on the view plane at distance 1.
vec2 pixel_slope() {
  return (gl_FragCoord.xy - 0.5 * vec2(frame.frame_size)) *
         vec2(length(frame.view_ray_dx.xyz), length(frame.view_ray_dy.xyz));
}

// A fragment stands for the piece of its line between two columns of pixels (or rows, or across a beam), as far as the line
// reaches and the surface at the pixel's centre does not hide it.
LineFragment line_fragment(int node) {
  LineFragment f;
  float pixel = length(frame.view_ray_dx.xyz);
  float depth = texelFetch(gbuffer_depth, ivec2(gl_FragCoord.xy), 0).x;
#if KIND == 1
  float on_line = caustic_point_node(line_origin + line_range.x * line_direction, line_origin + line_range.y * line_direction,
                                     (float(node) + 0.5) / float(line_nodes));
  f.along = mix(line_range.x, line_range.y, on_line);
  f.place = line_origin + f.along * line_direction;
  f.share = depth > 0.0 && f.place.z > depth ? 0.0 : 1.0 / float(line_nodes);
#else
  float middle = dot(line_axis, pixel_slope());
  vec2 part = caustic_line_part(line_origin, line_direction, line_axis, line_range.xy, depth,
                                vec2(middle - 0.5 * pixel, middle + 0.5 * pixel));
  float at = caustic_line_position(line_origin, line_direction, line_axis, line_axis * (0.5 * (part.x + part.y)));
  f.along = clamp(at, line_range.x, line_range.y);
  f.place = line_origin + f.along * line_direction;
  f.share = max(part.y - part.x, 0.0) / pixel;
#endif
  return f;
}

// Metres of medium of density 1 that weigh as much as the ray's way to the fragment; rays end where the medium does.
float line_medium_length(Medium medium, CausticRay ray, LineFragment f) {
#if MEDIUM_STEPS > 0
  return medium_length(medium, ray.start, ray.direction, f.along);
#else
  return f.along;
#endif
}

// Radiance per (flux * sigma_s * p * transmittances), 1/m.
float line_weight(LineFragment f) {
#if KIND == 1
  return f.share * line_range.z;
#else
  float rate = dot(caustic_line_rate(f.place, line_direction), line_axis);
  float focal = 1.0 / length(frame.view_ray_dx.xyz);
  float weight = f.share * caustic_line_weight(f.place, rate, focal);
#if KIND == 2
  vec2 across = vec2(-line_axis.y, line_axis.x);
  float away = focal * (dot(across, pixel_slope()) - caustic_line_picture(f.place, across));
  vec2 widths = abs(line_width.xy) / line_width.z;
  weight *= caustic_beam_profile(widths.x, widths.y, away);
#endif
  return weight;
#endif
}

// W/(sr m^2) that the medium scatters of the ray's light at a fragment towards the camera: each technique has its own.
vec3 scattered_at(Medium medium, CausticRay ray, LineFragment f);

void main() {
  CausticRay ray = rays[ray_index];
  Medium medium = scene_medium();
  vec3 sum = vec3(0.0);
  for (int i = 0; i < line_nodes; ++i) {
    LineFragment f = line_fragment(i);
    if (f.share != 0.0) sum += scattered_at(medium, ray, f);
  }
  if (sum == vec3(0.0)) discard;
  radiance = vec4(sum, 0.0);
}

#endif  // LIMN_LINE_FRAGMENT_GLSL
