// The mean over the profile of the light that enters around a pixel: points drawn around it in the plane that touches the
// surface stand for the places that rays through them see. The pixels of a work group have the same place, its z, in a pattern
// of block x block, for which they draw every block^2-th point of their body's sequence. Where light gets less far, the pattern is
// smaller, and takes fewer of these sets (pattern_weights.glsl). A dispatch answers for all bodies with the program's TEXTURED.
//
// What it stores still lacks a factor that varies with the pixel's own colour (exit.comp.glsl): without textures C, with them
// its root. In alpha it says over how much is averaged (pattern_weights.glsl).
//
// SAMPLES: points of each pixel. DISC_POINTS: how many of them, the last ones, are drawn from the disc. NORMALISE:
// entry_normalise_*. PLANES 2: half of the points lie in the plane that faces the camera. ROOT 1: at a border of two colours the
// profile is the root of both, else that of the pixel. POINT_COUNT: of all points, where they fit a uniform block. LIGHT_VIEWS 1:
// light also enters where the camera does not look (light_views.glsl).
#include "glsl/diffusion/entry_sums.glsl"
#include "glsl/diffusion/eye_plane.glsl"
#include "glsl/numeric/geometry.glsl"
#include "techniques/subsurface_scattering/entry_texel.glsl"
#include "techniques/subsurface_scattering/pattern_weights.glsl"
#include "techniques/subsurface_scattering/pixel_body.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
#if TEXTURED
#define Point PointDraw
#else
#define Point DrawnPoint
#endif
#ifdef POINT_COUNT  // they fit a uniform block, from which all invocations of a body load at once
layout(std140) uniform Points { Point points[POINT_COUNT]; };
#else
layout(std430) readonly buffer Points { Point points[]; };
#endif
uniform usampler2D planes;
uniform usampler2D entries;
layout(rgba32f) writeonly uniform image2D gathered;
uniform int block;  // pixels

vec3 entering_light(ivec2 pixel) { return uintBitsToFloat(entry_unpack(texelFetch(entries, pixel, 0).xy)); }

// A plane around the pixel's place in which points are drawn.
struct DrawingPlane {
  vec3 plane;  // eye_plane
  vec3 tangent, bitangent;              // m for a unit of length
  vec3 screen_tangent, screen_bitangent;  // the same in homogeneous pixels
};

// From places, from the eye, to homogeneous pixels.
mat3 screen_of_places() {
  vec3 dx = frame.view_ray_dx.xyz, dy = frame.view_ray_dy.xyz, origin = frame.view_ray_origin.xyz;
  vec3 x = cross(dy, origin), y = cross(origin, dx), z = cross(dx, dy);
  return transpose(mat3(x, y, z) / dot(x, dx));
}

DrawingPlane drawing_plane(vec3 place, vec3 normal, vec3 own_plane, float unit, mat3 screen) {
  Frame f = frame_around(normal);
  DrawingPlane p;
  p.plane = own_plane;
  p.tangent = unit * f.t;
  p.bitangent = unit * f.b;
  p.screen_tangent = screen * p.tangent;
  p.screen_bitangent = screen * p.bitangent;
  return p;
}

// What points are drawn from in a plane: the profile of the pixel's own colour, and with WIDEST also that of the body's least
// absorbing one. The root of two profiles, which light between two colours goes by, is at most their mean, so that no point
// weighs much however it was met.
#define WIDEST (TEXTURED && ROOT)
struct Drawing {
  ProfileColours colours;
  PointSource source;
#if WIDEST
  ProfileColours widest;
  PointSource widest_source;
#endif
};

float radius_drawn(Drawing d, int i, PointDraw draw) {
#if WIDEST
  if (drawn_from_wider(i)) return drawn_radius(d.widest, d.widest_source, draw);
#endif
  return drawn_radius(d.colours, d.source, draw);
}

// At distance r, per area of the plane.
float density_drawn(Drawing d, float r) {
  float density = drawn_density(diffusion_density(d.colours, r), d.source, r);
#if WIDEST
  float other = drawn_density(diffusion_density(d.widest, r), d.widest_source, r);
  density = mix(density, other, drawn_wider_share(SAMPLES - DISC_POINTS));
#endif
  return density;
}

// The same per area of what the ray `towards` meets.
float plane_density(Drawing d, vec3 plane, float stretch, float r, float area) {
  float density = density_drawn(d, r);
#if NORMALISE == 1
  return density;
#else
  return density * eye_plane_area(plane, stretch) / area;
#endif
}

// Point i of the pixel, which is number `index` of all.
DrawnPoint drawn_point(Drawing d, int i, uint index) {
#if TEXTURED
  PointDraw draw = points[index];
  float r = radius_drawn(d, i, draw);
  return DrawnPoint(r * draw.direction, 1.0 / density_drawn(d, r), 0.0);
#else
  return points[index];
#endif
}

#if LIGHT_VIEWS
#include "techniques/subsurface_scattering/light_views.glsl"
#endif

void main() {
  int z = int(gl_WorkGroupID.z);
  ivec2 pixel = block * ivec2(gl_GlobalInvocationID.xy) + ivec2(z % block, z / block);
  ivec2 size = ivec2(frame.frame_size);
  if (any(greaterThanEqual(pixel, size))) return;
  uvec4 own = texelFetch(planes, pixel, 0);
  uint body_index = bodies_of_instances[own.w != no_instance ? own.w : 0u];
  DiffusionBody body = bodies[body_index != no_body ? body_index : 0u];
  DiffusionBoundary boundary = diffusion_boundary(body.eta, body.entering);
  vec3 absorption = pixel_absorption(body, boundary, pixel);
  vec3 own_plane = uintBitsToFloat(own.xyz);
  float depth = 1.0 / dot(own_plane, pixel_ray(pixel));
  vec3 reach = diffusion_reach(body.extinction, absorption, walk_reflectance(boundary));  // units
  vec3 pixels = reach * pixels_of_unit(body, depth);
  int side = pattern_side(pixels, block);
  uint sub_buffer = uint(pattern_set(pixel, side, block));
  bool asked = own.w != no_instance && body_index != no_body && (body.textured != 0u) == (TEXTURED != 0);
  if (asked) {
    ProfileColours colours = profile_colours(body.extinction, absorption, boundary);
    Drawing from;
    from.colours = colours;
    from.source = PointSource(body.channels, body.uniform_share, body.uniform_radius);
#if TEXTURED
    from.source.channels = diffusion_drawn_channels(reach);
#endif
#if WIDEST
    from.widest = profile_colours(body.extinction, body.absorption, boundary);
    from.widest_source = PointSource(body.channels, body.uniform_share, body.uniform_radius);
#endif
    float per_metre = 1.0 / body.unit;
    vec3 place = depth * pixel_ray(pixel);
    mat3 screen = screen_of_places();
    vec3 screen_place = screen * place;
    float own_area = length(own_plane);
    DrawingPlane drawing = drawing_plane(place, -own_plane / own_area, own_plane, body.unit, screen);
#if PLANES == 2
    vec3 facing_plane = place / dot(place, place);
    DrawingPlane facing = drawing_plane(place, -normalize(place), facing_plane, body.unit, screen);
#endif
    vec3 light = vec3(0.0), weights = vec3(0.0);
#if WIDEST
    vec3 shared_weights = vec3(0.0);
#endif
    float hits = 0.0, inside_picture = 0.0;
    uint index = body.first_point + sub_buffer * uint(SAMPLES);
    for (int i = 0; i < SAMPLES; ++i, ++index) {
      DrawnPoint point = drawn_point(from, i, index);
      vec2 at = point.offset;
#if PLANES == 2
      bool faces = i % 2 == 1;
      DrawingPlane p = faces ? facing : drawing;
#else
      DrawingPlane p = drawing;
#endif
      vec3 offset = at.x * p.tangent + at.y * p.bitangent;
      vec3 towards = place + offset;
      vec3 shown = screen_place + at.x * p.screen_tangent + at.y * p.screen_bitangent;
      vec2 tap_at = shown.xy / max(shown.z, 1e-30) + 0.5;
      bool inside = shown.z > 0.0 && all(greaterThanEqual(tap_at, vec2(0.0))) && all(lessThan(tap_at, vec2(size)));
      ivec2 tap = inside ? ivec2(tap_at) : pixel;
      uvec4 met = texelFetch(planes, tap, 0);
      vec3 plane = uintBitsToFloat(met.xyz);
      // On the pixel's own plane what is left of the way from the eye is exactly that of the offset.
      float inverse = tap == pixel ? 1.0 + dot(own_plane, offset) : dot(plane, towards);
      bool hit = inside && met.w == own.w && inverse > 1.0 / eye_plane_most_stretch;
      float stretch = hit ? 1.0 / inverse : 1.0;
      float r = max(per_metre * eye_plane_distance(offset, towards, stretch), 1e-12);
      vec3 densities = diffusion_density(colours, r);
      float area = eye_plane_area(plane, stretch);
#if PLANES == 2
      vec3 other_plane = faces ? own_plane : facing_plane;
      float other_stretch = eye_plane_stretch(other_plane, towards);
      float other_r = max(per_metre * eye_plane_distance(offset, towards, other_stretch), 1e-12);
      float density = plane_density(from, p.plane, 1.0, length(at), area);
      float other = plane_density(from, other_plane, other_stretch, other_r, area);
      float share = float((SAMPLES + 1 - i % 2) / 2) / float(SAMPLES);  // of the points in this plane
      density = share * density + (1.0 - share) * (other_stretch > 0.0 ? other : 0.0);
      float inverse_density = 1.0 / density;
#else
      float inverse_density = point.inverse_density;
#if NORMALISE != 1
      inverse_density *= area / own_area;
#endif
#endif
      vec3 weight = densities * inverse_density;
#if TEXTURED && ROOT
      ProfileColours there = profile_colours(body.extinction, pixel_absorption(body, boundary, tap), boundary);
      vec3 shared_weight = sqrt(densities * there.reflectance * diffusion_density(there, r)) * inverse_density;
#else
      vec3 shared_weight = weight;
#endif
      if (inside) inside_picture += 1.0;
      if (hit) {
        light += shared_weight * entering_light(tap);
        weights += weight;
        hits += 1.0;
#if WIDEST
        shared_weights += shared_weight;
#endif
      }
    }
    vec3 here = entering_light(pixel);
#if TEXTURED && ROOT
    here *= sqrt(colours.reflectance);
#endif
    vec3 sums = weights;
#if WIDEST
    // The integral over the root of two profiles is at most the root of both reflectances (Cauchy-Schwarz). Without this, a dark
    // pixel's few weights far away would be divided by almost nothing.
    sums = max(sums, shared_weights * inversesqrt(max(from.widest.reflectance, vec3(1e-30))));
#endif
    vec3 mean = entry_mean(light, sums, hits, float(SAMPLES), NORMALISE, here);
#if LIGHT_VIEWS
    mean *= entry_seen_share(weights, hits, inside_picture, NORMALISE);
    vec3 hidden = hidden_light(from, body, boundary, place, own.w, sub_buffer, screen);
#if TEXTURED && ROOT
    hidden *= sqrt(colours.reflectance);
#endif
    mean += hidden;
#endif
    imageStore(gathered, pixel, vec4(mean, pattern_pack(side, pattern_narrow(pixels, side), pattern_shares(pixels))));
  }
}
