// Soft shadows of virtual area lights from the Fourier basis maps of their paraboloid maps (thesis, section 6.3.2): mean
// blocker depth in a first kernel, penumbra, visibility in the penumbra's kernel. Depths are radial.
//
// KERNEL_THESIS 1: widths as published. SEARCH_NEAREST 1: the first kernel starts from the nearest depth there is; 0: it is
// the light's own solid angle, as published. AREA_DIP: least s of what is lit. SPLITS: parts of a kernel per axis, each with
// a threshold of its own. CONTACT 1: blockers whose penumbrae are narrow are found in the map itself.
#ifndef LIMN_AREA_VISIBILITY_GLSL
#define LIMN_AREA_VISIBILITY_GLSL
#include "glsl/shadow/fourier_lookup.glsl"
#include "glsl/shadow/min_max_pyramid.glsl"
#include "glsl/shadow/paraboloid.glsl"
#include "glsl/indirect/virtual_area_light.glsl"

uniform sampler2DArray area_depth_bounds;  // MinMaxPyramid
#if CONTACT
uniform sampler2DArray area_depths;
uniform float contact_texels;
#endif
#ifdef AREA_COUNT  // they fit uniform blocks, from which all invocations load at once
layout(std140) uniform AreaViews { ShadowView area_views[AREA_COUNT]; };
layout(std140) uniform AreaLights { VirtualAreaLight area_lights[AREA_COUNT]; };
#else
layout(std430) readonly buffer AreaViews { ShadowView area_views[]; };
layout(std430) readonly buffer AreaLights { VirtualAreaLight area_lights[]; };
#endif
uniform float bias;    // texel footprints
uniform float behind;  // visibility of what lies behind an area light, where its map knows nothing

// Blockers so close to the receiver that the series answers them with less are not made up for.
const float least_response = max(0.02, 8.0 * FOURIER_NOISE);

// What all receivers have in common.
struct AreaLight {
  ShadowView view;
  FourierRange range;
  vec2 sides;  // m
};

AreaLight area_light(uint area) {
  return AreaLight(area_views[area], fourier_ranges[area], area_lights[area].extent);
}

// A receiver as one map sees it.
struct AreaReceiver {
  ShadowView view;
  FourierRange range;
  vec3 direction;  // unit, in the view's axes
  vec3 normal;
  float height;    // of the tangent plane over the view's origin, raised by the bias, m; < 0: the origin lies above it
  float limit;     // radial distance beyond which nothing blocks, m
  float d;         // radial distance, m
  vec2 sides;      // of the light
};

// Radial distance, m, below which what lies at uv blocks: what is nearer to the light than the receiver, and above its
// tangent plane.
float blocking_limit(AreaReceiver r, vec2 uv) {
  float facing = dot(r.normal, paraboloid_direction(2.0 * uv - 1.0));
  bool bounded = r.height < 0.0 && facing < 0.0;
  return bounded ? min(r.height / facing, r.limit) : r.limit;
}

// The same as a depth of the series, at a place in texels.
float series_threshold(AreaReceiver r, vec2 texel) {
  vec2 uv = texel / float(r.view.size);
  return fourier_depth(r.range, uv, shadow_normalise(r.view, blocking_limit(r, uv)));
}

struct SeriesPart {
  float threshold;
  float dip;  // least s that the part has where nothing in it blocks
};

// The threshold of a box of texels is the middle one, unless a lit plane would then span more depth within the box than
// ringing suppression absorbs.
SeriesPart series_part(AreaReceiver r, vec2 low, vec2 high) {
  float middle = series_threshold(r, 0.5 * (low + high));
  float t00 = series_threshold(r, low);
  float t10 = series_threshold(r, vec2(high.x, low.y));
  float t01 = series_threshold(r, vec2(low.x, high.y));
  float t11 = series_threshold(r, high);
  float least = min(min(min(t00, t10), min(t01, t11)), middle);
  float before = min(middle - least, FOURIER_TOLERANCE);
  SeriesPart part;
  part.threshold = clamp(least + before, 0.0, FOURIER_RANGE);
  part.dip = min(FOURIER_LEVEL - FOURIER_CURVATURE * before * before, AREA_DIP) - FOURIER_NOISE;
  return part;
}

// Texels (low, high) of the penumbra's kernel for blockers at radial distance z.
vec4 kernel_texels(AreaReceiver r, float z) {
#if KERNEL_THESIS
  vec4 kernel = paraboloid_rectangle_kernel_thesis(r.direction, r.sides, r.d, z);
#else
  vec4 kernel = paraboloid_rectangle_kernel(r.direction, r.sides, r.d, z);
#endif
  float size = float(r.view.size);
  vec2 centre = (0.5 * kernel.xy + 0.5) * size;
  vec2 reach = 0.5 * max(kernel.zw * size, vec2(1.0));
  return clamp(vec4(centre - reach, centre + reach), vec4(0.0), vec4(size));
}

float stored_metres(AreaReceiver r, float series) {
  return shadow_metres(r.view, fourier_stored(r.range, vec2(0.5), series));
}

vec4 search_kernel(AreaReceiver r) {
#if SEARCH_NEAREST
  float z = clamp(stored_metres(r, 0.0), 0.02 * r.d, r.d);
  vec4 kernel = kernel_texels(r, z);
  float nearest = min_max_depth(area_depth_bounds, ivec2(kernel.xy), ivec2(ceil(kernel.zw)) - 1, int(r.view.layer)).x;
  return kernel_texels(r, clamp(shadow_metres(r.view, nearest), z, r.d));
#else
  return kernel_texels(r, 0.5 * r.d);
#endif
}

// Stages 1 and 2: mean radial distance of the blockers in the kernel; as far as the receiver where there are none.
float mean_blocker(AreaReceiver r, vec4 kernel) {
  int layer = int(r.view.layer);
  vec2 part_size = (kernel.zw - kernel.xy) / float(SPLITS);
  float blocked = 0.0;
  float depths = 0.0;
  int i = 0;
  do {
    vec2 low = kernel.xy + vec2(i % SPLITS, i / SPLITS) * part_size;
    SeriesPart part = series_part(r, low, low + part_size);
    FourierMeans means = fourier_means(low, low + part_size, ivec2(r.view.size), layer);
    vec2 sums = fourier_shadow(means, part.threshold);
    float share = 1.0 - sums.x;
    if (share > 1.0 - part.dip) {
      blocked += share;
      depths += share * clamp(sums.y / share, 0.0, part.threshold);
    }
  } while (++i < SPLITS * SPLITS);
  return blocked > 0.0 ? min(stored_metres(r, depths / blocked), r.d) : r.d;
}

// Stage 3: visibility in the penumbra's kernel, normalised by what a blocker at their mean depth gives.
float penumbra_visibility(AreaReceiver r, vec4 kernel, float z) {
  int layer = int(r.view.layer);
  vec2 part_size = (kernel.zw - kernel.xy) / float(SPLITS);
  float depth = fourier_depth(r.range, vec2(0.5), shadow_normalise(r.view, z));
  float sum = 0.0;
  int i = 0;
  do {
    vec2 low = kernel.xy + vec2(i % SPLITS, i / SPLITS) * part_size;
    SeriesPart part = series_part(r, low, low + part_size);
    FourierMeans means = fourier_means(low, low + part_size, ivec2(r.view.size), layer);
    float gain = 0.5 / (part.dip - 0.5);
    float v = fourier_visibility(fourier_shadow(means, part.threshold).x, gain);
    float blocked = fourier_visibility(fourier_step(min(depth - part.threshold, 0.0)), gain);
    sum += fourier_normalised(v, blocked, least_response);
  } while (++i < SPLITS * SPLITS);
  return sum / float(SPLITS * SPLITS);
}

#if CONTACT
// Share of the light that blockers just before the receiver leave, of which the series knows nothing: their penumbrae are
// narrower than `contact_texels`, so that a bilinear shadow test is as good as a kernel.
float contact_visibility(AreaReceiver r) {
  float size = float(r.view.size);
  vec2 at = (0.5 * paraboloid_map(r.direction) + 0.5) * size - 0.5;
  vec2 corner = floor(at);
  vec2 share = at - corner;
  vec4 stored = textureGather(area_depths, vec3((corner + 1.0) / size, r.view.layer));  // (0,1), (1,1), (1,0), (0,0)
  // Penumbrae of `sides` s are s (d - z) / (d z) radians wide.
  float angle = contact_texels * r.view.footprint;
  float nearest = r.d / (1.0 + angle * r.d / max(max(r.sides.x, r.sides.y), 1e-30));
  vec4 limit = vec4(blocking_limit(r, (corner + vec2(0.5, 1.5)) / size), blocking_limit(r, (corner + vec2(1.5, 1.5)) / size),
                    blocking_limit(r, (corner + vec2(1.5, 0.5)) / size), blocking_limit(r, (corner + vec2(0.5, 0.5)) / size));
  vec4 depth = vec4(shadow_metres(r.view, stored.x), shadow_metres(r.view, stored.y), shadow_metres(r.view, stored.z),
                    shadow_metres(r.view, stored.w));
  vec4 lit = 1.0 - vec4(lessThan(depth, limit)) * vec4(greaterThan(depth, vec4(nearest)));
  vec2 rows = mix(lit.wx, lit.zy, share.x);
  return mix(rows.x, rows.y, share.y);
}
#endif

AreaReceiver area_receiver(AreaLight light, vec3 p, vec3 normal) {
  AreaReceiver r;
  r.view = light.view;
  vec3 local = shadow_local(r.view, p);
  r.d = max(length(local), 1e-30);
  r.direction = local / r.d;
  r.direction.z = max(r.direction.z, 0.0);
  r.normal = shadow_view_axes(r.view, normal);
  float raised = bias * r.view.footprint * r.d;
  r.height = dot(r.normal, local) + raised;
  r.limit = max(r.d - raised, 0.0);
  r.range = light.range;
  r.sides = light.sides;
  return r;
}

// Share of an area light that the point p with the geometric normal sees.
float area_visibility(AreaLight light, vec3 p, vec3 normal) {
  AreaReceiver r = area_receiver(light, p, normal);
  float above = dot(r.view.axis_z, p - r.view.origin);
  float z = mean_blocker(r, search_kernel(r));
  float v = z < r.d ? penumbra_visibility(r, kernel_texels(r, z), z) : 1.0;
#if CONTACT
  v = min(v, contact_visibility(r));
#endif
  if (r.d <= r.view.near) v = 1.0;
  return above > 0.0 ? v : behind;
}

#endif  // LIMN_AREA_VISIBILITY_GLSL
