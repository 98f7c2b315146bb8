// The shade pass of techniques that gather indirect light from virtual point lights. The work groups of one z shade the
// pixels of one sub-buffer, which all have the same virtual lights. SPLIT 1: the G-buffer and the result lie sub-buffer by
// sub-buffer; 0: both are screens. The result has the layers gather_part_*. LAMBERTIAN 1: no lit surface has a specular
// part. MATERIAL_MODELS, SURFACE_TANGENTS: see surface_response.glsl. ACCUMULATE 1: adds to what other batches of lights left.
// VIRTUAL_LIGHT_COUNT: of lights, where they fit a uniform block.
//
// GATHER_FALLING 1: the residual is what lies between the bound of a pixel that is the mean of nothing but its own lights and that
// of one that is the mean of all sub-buffers' (blur.comp.glsl).
//
// GATHER_GLOSSY 1: the specular part has a bound of its own, wider than that of a pixel that is the mean of several frames.
//
// GATHER_COLOURLESS 1: the specular part is left over the surface's specular reflectance, which the blur multiplies it by in the
// end: neither textures nor the edges of materials are blurred with it.
//
// llvmpipe leaves all loops of a thread after 65,535 steps in all: there a pass takes batch_count of the lights that a thread has.
//
// A thread shades four pixels of its sub-buffer, so that a light is loaded once for them: one in each quarter of what its work
// group shades, so that neighbouring threads shade neighbours. They have names of their own in what follows: compilers keep
// what a loop indexes in memory.
//
// GATHER_PATCH 1: the inverse square is bounded by the patch that a light stands for instead of by a part of the scene's extent.
//
// GATHER_EDGES 1: after the blur, the pixels that it does not serve get all virtual lights (on_edge()). A thread shades one of
// them.
//
// Define GATHER_PIXELS 1 before including this where a thread shades one pixel: where visibility takes more than the light, so
// that a loop over lights does better with few values to keep.
//
// Define VPL_SHADOWS 1 before including this where virtual lights have shadows: vpl_begin() and vpl_visibility() are then the
// technique's. Define VPL_AREAS 1 instead, with GATHER_PIXELS 1, where the lights of an area (`cluster`) share a shadow, and lights
// of one area follow each other: vpl_area_visibility() is then the technique's, and is asked once for all of them.
#ifndef LIMN_GATHER_MAIN_GLSL
#define LIMN_GATHER_MAIN_GLSL
#include "glsl/surface/brdf_view.glsl"
#include "glsl/surface/reflectance.glsl"
#include "glsl/surface/surface_response.glsl"
#include "glsl/indirect/gather.glsl"
#include "glsl/indirect/gather_parts.glsl"
#include "glsl/indirect/virtual_light.glsl"

#if GATHER_EDGES
#undef GATHER_PIXELS
#define GATHER_PIXELS 1
#define THREADS 256
#include "glsl/numeric/work_group.glsl"
#endif
#ifndef GATHER_PIXELS
#define GATHER_PIXELS 4
#endif
#ifndef VPL_AREAS
#define VPL_AREAS 0
#endif

// A work group shades 16 x 16 pixels of a sub-buffer.
#if GATHER_PIXELS == 4
layout(local_size_x = 8, local_size_y = 8) in;
#else
layout(local_size_x = 16, local_size_y = 16) in;
#endif
#ifdef VIRTUAL_LIGHT_COUNT  // they fit a uniform block, from which all invocations load at once
layout(std140) uniform VirtualLights { VirtualPointLight virtual_lights[VIRTUAL_LIGHT_COUNT]; };
#else
layout(std430) readonly buffer VirtualLights { VirtualPointLight virtual_lights[]; };
#endif
#if ACCUMULATE
layout(rgba32f) uniform image2DArray gathered;
#else
layout(rgba32f) writeonly uniform image2DArray gathered;
#endif
uniform uint vpl_count;  // N
uniform float nearest;   // part of the scene's extent; GATHER_PATCH: of the root of a light's area
#if GATHER_FALLING
uniform float least_nearest;  // the same, where a pixel is the mean of all sub-buffers: the residual is what lies between
#endif
#if GATHER_GLOSSY
uniform float glossy_nearest;  // the same, of the specular part
#endif

uniform uint batch_first;  // virtual lights that this pass may use
uniform uint batch_count;
#if !GATHER_EDGES
uniform uint block;        // pixels
uniform float part_of_all;  // 1, or with a history the part of the lights that a pixel has where no blur brings the others
#else
uniform sampler2DArray blurred;  // along both axes, along rows alone, along columns alone
uniform sampler2DArray rows;
uniform sampler2DArray columns;
uniform float edges;  // by which these may differ, in means of the work group's pixels
#endif

struct Receiver {
#if VPL_AREAS
  float seen;             // share of the area whose lights are gathered
#endif
  vec3 position;
  vec3 normal;            // shading; 0 where there is nothing to light
  vec3 geometric_normal;
#if !LAMBERTIAN
  BrdfView brdf;
#endif
#if MATERIAL_MODELS
  SurfaceMaterial material;
  vec3 to_viewer;
#endif
  float least;            // m^2: of the pixel on the surface, over pi, or the square of the least bound
#if GATHER_GLOSSY
  float glossy_nearest2;  // m^2: the square of the specular part's bound
#endif
};

// A virtual light as a receiver sees it.
struct VplSight {
  vec3 offset;              // from the receiver to the light, m
  float d2;                 // its square
  float above;              // product of the receiver's geometric normal with it, > 0
  float towards_receiver;   // of the light's normal with the way back, > 0
};

#if VPL_SHADOWS
// Called for each light before vpl_visibility(): what all pixels have in common.
void vpl_begin(uint vpl, VirtualPointLight light);

// Whether pixel 0 to 3 of the thread sees the light: 1, or does not: 0. Asked only where it matters.
float vpl_visibility(VirtualPointLight light, uint pixel, Receiver r, VplSight sight);
#elif VPL_AREAS
// The share of an area light that the receiver sees.
float vpl_area_visibility(uint area, Receiver r);
#endif

// Sums over lights, of which constant factors are left out.
struct Gathered {
  vec3 diffuse;   // per unit of the diffuse albedo
  vec3 specular;
  vec3 residual;  // of the diffuse part
};

// The square of a bound on distances: m^2, or GATHER_PATCH: of a light that stands for 1 m^2.
float squared_bound(float bound) {
#if !GATHER_PATCH
  bound *= gather_extent();
#endif
  return bound * bound;
}

#if GATHER_PATCH
#define GATHER_GEOMETRY gather_patch_geometry
#define GATHER_RESIDUE gather_patch_residual
#define GATHER_REBOUND gather_patch_rebound
#else
#define GATHER_GEOMETRY gather_geometry
#define GATHER_RESIDUE gather_residual
#define GATHER_REBOUND gather_rebound
#endif

void gather_from(VirtualPointLight light, uint pixel, Receiver r, float nearest2, inout Gathered sum) {
#if GATHER_PATCH
  nearest2 *= light.area;
#if GATHER_FALLING
  r.least *= light.area;
#endif
#if GATHER_GLOSSY
  r.glossy_nearest2 *= light.area;
#endif
#endif
  VplSight sight;
  sight.offset = light.position - r.position;
  sight.d2 = dot(sight.offset, sight.offset);
  sight.above = dot(r.geometric_normal, sight.offset);
  sight.towards_receiver = -dot(light.normal, sight.offset);
  float towards_light = dot(r.normal, sight.offset);
  bool lit = towards_light > 0.0 && sight.above > 0.0 && sight.towards_receiver > 0.0;
  float share = lit ? GATHER_GEOMETRY(towards_light, sight.towards_receiver, sight.d2, nearest2) : 0.0;
#if VPL_SHADOWS
  float visibility = 1.0;
  if (lit) visibility = vpl_visibility(light, pixel, r, sight);
  share *= visibility;
#elif VPL_AREAS
  if (lit) share *= r.seen;
#endif
#if !LAMBERTIAN
  vec3 l = inversesqrt(max(sight.d2, 1e-37)) * sight.offset;
  BrdfParts parts = brdf_view_parts(r.brdf, l);
#if (MATERIAL_MODELS & 128) != 0
  // Over the mean share, which the G-buffer holds as the base colour.
  parts.diffuse = inverse_pi * entry_share(r.material.model, dot(r.normal, l)) / r.material.model.kd.x;
  parts.specular = vec3(0.0);
#elif MATERIAL_MODELS
  // All of it: what is left of the surface without its specular part is black, and has a diffuse part for what lies around it.
  if (has_model(r.material))
    parts.specular = surface_response(r.material, r.normal, r.to_viewer, l) / max(dot(r.normal, l), 1e-6);
#endif
#if GATHER_GLOSSY
  float glossy = share * GATHER_REBOUND(sight.d2, nearest2, r.glossy_nearest2);
#else
  float glossy = share;
#endif
  sum.specular += (glossy * parts.specular) * light.flux.rgb;
  share *= parts.diffuse;
#endif
  sum.diffuse += share * light.flux.rgb;
#if GATHER_RESIDUAL
  sum.residual += (share * GATHER_RESIDUE(sight.d2, nearest2, r.least)) * light.flux.rgb;
#endif
}

// Light i, for gather_from() of all pixels.
VirtualPointLight begin_light(uint i) {
  VirtualPointLight light = virtual_lights[i];
  if (!virtual_light_shines(light)) light.normal = vec3(0.0);  // so that no receiver is lit
#if VPL_SHADOWS
  vpl_begin(i, light);
#endif
  return light;
}

#if GATHER_PIXELS == 1
// Lights first to end - 1, at least one, for one pixel. Conditions of loops come last: software renderers run a loop's body once
// more where it comes first, wanted or not. That is why areas have a loop of their own around that over lights.
void gather_lights(uint first, uint end, inout Receiver r, inout Gathered sum) {
  float nearest2 = squared_bound(nearest);
  uint i = first;
#if VPL_AREAS
  float area = virtual_lights[i].cluster;
  do {
    float this_area = area;
    r.seen = vpl_area_visibility(uint(area), r);
    do {
      VirtualPointLight light = begin_light(i);
      gather_from(light, 0u, r, nearest2, sum);
      area = virtual_lights[min(++i, end - 1u)].cluster;
    } while (i < end && area == this_area);
  } while (i < end);
#else
  do {
    VirtualPointLight light = begin_light(i);
    gather_from(light, 0u, r, nearest2, sum);
  } while (++i < end);
#endif
}
#endif

struct GatherPixel {
  ivec2 texel;   // in the G-buffer and the result
  bool inside;   // the picture
  bool covered;  // by a surface that gathers
};

GatherPixel gather_pixel(ivec2 pixel, out Receiver r) {
  GatherPixel p;
  ivec2 size = ivec2(frame.frame_size);
  p.inside = all(lessThan(pixel, size));
  pixel = min(pixel, size - 1);
#if SPLIT
  p.texel = split_texel(pixel, int(block), size);
#else
  p.texel = pixel;
#endif
  float depth = pixel_depth(p.texel);
  GBufferSurface surface = pixel_surface(p.texel);
  p.covered = p.inside && depth > 0.0 && (surface.flags & gbuffer_flag_specular) == 0u;
  r.position = pixel_position(pixel, depth);
  r.normal = p.covered ? surface.normal : vec3(0.0);
  r.geometric_normal = surface.geometric_normal;
#if !LAMBERTIAN
  SurfaceMaterial material = pixel_material(pixel, surface);
  vec3 to_viewer = normalize(frame.camera_position.xyz - r.position);
  r.brdf = brdf_view(material.brdf, surface.normal, to_viewer);
#if MATERIAL_MODELS
  r.material = material;
  r.to_viewer = to_viewer;
#endif
#endif
#if GATHER_FALLING
  r.least = squared_bound(least_nearest);
#else
  float footprint = depth * length(frame.view_ray_dx.xyz);
  r.least = footprint * footprint * inverse_pi;
#endif
#if GATHER_GLOSSY
  r.glossy_nearest2 = squared_bound(glossy_nearest);
#endif
  return p;
}

#if GATHER_EDGES
const float least_share = 0.25;  // of the pattern that the blur must find

float brightness(vec3 light) { return light.r + light.g + light.b; }

// Of the pattern that the blur found.
float blurred_share(ivec2 pixel) { return texelFetch(blurred, ivec3(pixel, gather_part_diffuse), 0).a; }

float blurred_light(ivec2 pixel) {
  vec4 sum = texelFetch(blurred, ivec3(pixel, gather_part_diffuse), 0);
  return sum.a > 0.0 ? brightness(sum.rgb) / sum.a : 0.0;
}

// What was blurred along one axis; the same as blurred_light() where light is even along the other.
float line_light(sampler2DArray lines, ivec2 pixel) {
  vec4 sum = texelFetch(lines, ivec3(pixel, gather_part_diffuse), 0);
  float light = sum.a > 0.0 ? brightness(sum.rgb) / sum.a : 0.0;
#if GATHER_FALLING
  light += brightness(texelFetch(lines, ivec3(pixel, gather_part_residual), 0).rgb);
#endif
  return light;
}

// Whether the blur serves a pixel badly: it found less of the pattern than least_share, or mixes a line of pixels with others that
// get `most` more or less light, as in a slit.
bool on_edge(ivec2 pixel, float most) {
  float share = blurred_share(pixel);
  if (!(pixel_depth(pixel) > 0.0 && share > 0.0)) return false;
  float light = blurred_light(pixel);
  float off = max(abs(line_light(rows, pixel) - light), abs(line_light(columns, pixel) - light));
  return share < least_share || off > most;
}
#endif

void store_part(ivec3 at, vec4 value) {
#if ACCUMULATE
  value.rgb += imageLoad(gathered, at).rgb;
#endif
  imageStore(gathered, at, value);
}

void store(GatherPixel p, Receiver r, Gathered sum) {
#if GATHER_EDGES
  const float part_of_all = 1.0;
  float scale = inverse_pi;
#if GATHER_FALLING
  sum.diffuse += sum.residual;
#endif
#else
  if (!p.inside) return;
  // For the lights that other sub-buffers have; a light of the flux F sends F / pi along its normal.
  float scale = part_of_all * (float(block * block) * inverse_pi);
#endif
  float weight = p.covered ? part_of_all : 0.0;
#if LAMBERTIAN
  float diffuse = scale * inverse_pi;
#else
  float diffuse = scale;
#endif
  store_part(ivec3(p.texel, gather_part_diffuse), vec4(diffuse * sum.diffuse, weight));
#if GATHER_SPECULAR
  vec3 specular = scale * sum.specular;
  float specular_weight = weight;
#if GATHER_COLOURLESS
  vec3 reflectance = r.brdf.f0 + mean_schlick_weight * r.brdf.f_rise;  // specular_reflectance()
  specular /= max(reflectance, vec3(1e-30));
  // Surfaces without a specular part have no share in that of others around them.
  if (!(reflectance.x > 0.0)) specular_weight = 0.0;
#endif
  store_part(ivec3(p.texel, gather_part_specular), vec4(specular, specular_weight));
#endif
#if GATHER_RESIDUAL && !(GATHER_EDGES && GATHER_FALLING)
  store_part(ivec3(p.texel, gather_part_residual), vec4(diffuse * sum.residual, weight));
#endif
}

#if GATHER_EDGES
shared uint edge_pixels[THREADS];  // x and y, 16 bits each
shared uint edge_count;

void main() {
  ivec2 size = ivec2(frame.frame_size);
  ivec2 own = ivec2(gl_GlobalInvocationID.xy);
  bool inside = all(lessThan(own, size));
  vec4 light = inside ? vec4(blurred_light(own), blurred_share(own) > 0.0 ? 1.0 : 0.0, 0.0, 0.0) : vec4(0.0);
  light = total(light);
  float most = edges * light.x / max(light.y, 1.0);
  if (gl_LocalInvocationIndex == 0u) edge_count = 0u;
  barrier();
  if (inside) {
    if (on_edge(own, most)) {
      edge_pixels[atomicAdd(edge_count, 1u)] = uint(own.x) | uint(own.y) << 16;
    } else if (ACCUMULATE == 0) {
      for (int part = 0; part < gather_parts - GATHER_FALLING; ++part)
        imageStore(gathered, ivec3(own, part), texelFetch(blurred, ivec3(own, part), 0));
    }
  }
  barrier();
  if (gl_LocalInvocationIndex >= edge_count) return;
  uint packed_pixel = edge_pixels[gl_LocalInvocationIndex];
  Receiver r;
  GatherPixel p = gather_pixel(ivec2(packed_pixel & 0xffffu, packed_pixel >> 16), r);
  Gathered sum = Gathered(vec3(0.0), vec3(0.0), vec3(0.0));
  gather_lights(batch_first, min(batch_first + batch_count, vpl_count), r, sum);
  store(p, r, sum);
}
#else
void main() {
  uint sub_buffer = gl_WorkGroupID.z;
  int step = 8 * int(block);
  ivec2 first_pixel = int(block) * ivec2(16u * gl_WorkGroupID.xy + gl_LocalInvocationID.xy) +
                      ivec2(sub_buffer % block, sub_buffer / block);
  uint first = max(gather_begin(sub_buffer, vpl_count, block), batch_first);
  uint end = min(gather_begin(sub_buffer + 1u, vpl_count, block), batch_first + batch_count);
  if (any(greaterThanEqual(first_pixel, ivec2(frame.frame_size)))) return;
  const Gathered nothing = Gathered(vec3(0.0), vec3(0.0), vec3(0.0));
  Receiver r00;
  GatherPixel p00 = gather_pixel(first_pixel, r00);
  Gathered sum00 = nothing;
  bool covered = p00.covered;
#if GATHER_PIXELS == 4
  Receiver r10, r01, r11;
  GatherPixel p10 = gather_pixel(first_pixel + ivec2(step, 0), r10);
  GatherPixel p01 = gather_pixel(first_pixel + ivec2(0, step), r01);
  GatherPixel p11 = gather_pixel(first_pixel + ivec2(step, step), r11);
  Gathered sum10 = nothing, sum01 = nothing, sum11 = nothing;
  covered = covered || p10.covered || p01.covered || p11.covered;
#endif
  if (covered && first < end) {
#if GATHER_PIXELS == 1
    gather_lights(first, end, r00, sum00);
#else
    float nearest2 = squared_bound(nearest);
    uint i = first;
    do {  // the condition comes last: software renderers run a loop's body once more where it comes first
      VirtualPointLight light = begin_light(i);
      gather_from(light, 0u, r00, nearest2, sum00);
      gather_from(light, 1u, r10, nearest2, sum10);
      gather_from(light, 2u, r01, nearest2, sum01);
      gather_from(light, 3u, r11, nearest2, sum11);
    } while (++i < end);
#endif
  }
  store(p00, r00, sum00);
#if GATHER_PIXELS == 4
  store(p10, r10, sum10);
  store(p01, r01, sum01);
  store(p11, r11, sum11);
#endif
}

#endif

#endif  // LIMN_GATHER_MAIN_GLSL
