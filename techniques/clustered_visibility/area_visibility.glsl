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
#ifdef AREA_VIEW_COUNT  // they fit a uniform block, from which all invocations load at once
layout(std140) uniform AreaViews { ShadowView area_views[AREA_VIEW_COUNT]; };
#else
layout(std430) readonly buffer AreaViews { ShadowView area_views[]; };
#endif
#ifdef AREA_COUNT  // likewise
layout(std140) uniform AreaLights { VirtualAreaLight area_lights[AREA_COUNT]; };
#else
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
  vec3 direction;      // unit, in the view's axes
  vec3 plane;          // of the tangent plane, raised by the bias: inverse radial distance along w is dot(plane, w), 1/m; 0 where
                       // the view's origin lies above it
  float inverse_limit; // of the radial distance beyond which nothing blocks, 1/m
  float d;             // radial distance, m
  vec2 sides;          // of the light
};

// Inverse radial distance, 1/m, above which what lies at a place in texels blocks: what is nearer to the light than the
// receiver, and above its tangent plane.
float inverse_blocking_limit(AreaReceiver r, vec2 texel) {
  vec2 p = 2.0 / float(r.view.size) * texel - 1.0;
  float rho2 = dot(p, p);
  // paraboloid_direction(p), with one division.
  return max((2.0 * dot(r.plane.xy, p) + r.plane.z * (1.0 - rho2)) / (1.0 + rho2), r.inverse_limit);
}

// A radial distance, m, as a depth of the series, whose range is the same in the whole map (FourierFit::map, ::range).
float series_depth(AreaReceiver r, float metres) {
  return fourier_depth(r.range, vec2(0.5), shadow_normalise(r.view, metres));
}

struct SeriesPart {
  float threshold;
  float dip;  // least s that the part has where nothing in it blocks
};

// The threshold of a box of texels is the middle one, unless a lit plane would then span more depth within the box than
// ringing suppression absorbs.
SeriesPart series_part(AreaReceiver r, vec2 low, vec2 high) {
  float centre = inverse_blocking_limit(r, 0.5 * (low + high));
  float corners = max(max(inverse_blocking_limit(r, low), inverse_blocking_limit(r, vec2(high.x, low.y))),
                      max(inverse_blocking_limit(r, vec2(low.x, high.y)), inverse_blocking_limit(r, high)));
  float middle = series_depth(r, 1.0 / centre);
  float least = series_depth(r, 1.0 / max(corners, centre));
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
    vec3 box = fourier_box(low, low + part_size, ivec2(r.view.size));
    vec4 basis[FOURIER_GROUPS];
    fourier_basis_means(box, layer, basis);
    float share = 1.0 - fourier_lit(basis, part.threshold);
    if (share > 1.0 - part.dip) {
      vec4 depth_basis[FOURIER_GROUPS];
      float depth = fourier_depth_means(box, layer, depth_basis);
      depth = fourier_blocker_depth(depth_basis, depth, part.threshold);
      blocked += share;
      depths += share * clamp(depth / share, 0.0, part.threshold);
    }
  } while (++i < SPLITS * SPLITS);
  return blocked > 0.0 ? min(stored_metres(r, depths / blocked), r.d) : r.d;
}

// Stage 3: visibility in the penumbra's kernel, normalised by what a blocker at their mean depth gives.
float penumbra_visibility(AreaReceiver r, vec4 kernel, float z) {
  int layer = int(r.view.layer);
  vec2 part_size = (kernel.zw - kernel.xy) / float(SPLITS);
  float depth = series_depth(r, z);
  float sum = 0.0;
  int i = 0;
  do {
    vec2 low = kernel.xy + vec2(i % SPLITS, i / SPLITS) * part_size;
    SeriesPart part = series_part(r, low, low + part_size);
    vec4 basis[FOURIER_GROUPS];
    fourier_basis_means(fourier_box(low, low + part_size, ivec2(r.view.size)), layer, basis);
    float gain = 0.5 / (part.dip - 0.5);
    float v = fourier_visibility(fourier_lit(basis, part.threshold), gain);
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
  vec4 limit = 1.0 / vec4(inverse_blocking_limit(r, corner + vec2(0.5, 1.5)), inverse_blocking_limit(r, corner + vec2(1.5, 1.5)),
                          inverse_blocking_limit(r, corner + vec2(1.5, 0.5)), inverse_blocking_limit(r, corner + vec2(0.5, 0.5)));
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
  vec3 axis = shadow_view_axes(r.view, normal);
  float raised = bias * r.view.footprint * r.d;
  float height = dot(axis, local) + raised;
  r.plane = height < -1e-30 ? axis / height : vec3(0.0);
  r.inverse_limit = 1.0 / max(r.d - raised, 1e-30);
  r.range = light.range;
  r.sides = light.sides;
  return r;
}

// Share of an area light that the point p with the geometric normal sees.
float area_visibility(AreaLight light, vec3 p, vec3 normal) {
  AreaReceiver r = area_receiver(light, p, normal);
  float above = dot(r.view.axis_z, p - r.view.origin);
  float z = mean_blocker(r, search_kernel(r));
  float v = 1.0;
  if (z < r.d) v = penumbra_visibility(r, kernel_texels(r, z), z);
#if CONTACT
  v = min(v, contact_visibility(r));
#endif
  if (r.d <= r.view.near) v = 1.0;
  return above > 0.0 ? v : behind;
}

#endif  // LIMN_AREA_VISIBILITY_GLSL
