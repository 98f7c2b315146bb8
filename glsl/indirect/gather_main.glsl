// The shade pass of techniques that gather indirect light from virtual point lights. The work groups of one z shade the
// pixels of one sub-buffer, which all have the same virtual lights. SPLIT 1: the G-buffer and the result lie sub-buffer by
// sub-buffer; 0: both are screens. PARTS: layers of the result (gather_part_*). LAMBERTIAN 1: no material has a specular
// part. ACCUMULATE 1: adds to what other batches of lights left.
//
// The technique defines vpl_visibility().
#ifndef LIMN_GATHER_MAIN_GLSL
#define LIMN_GATHER_MAIN_GLSL
#include "glsl/surface/brdf.glsl"
#include "glsl/surface/gbuffer_input.glsl"
#include "glsl/indirect/gather.glsl"
#include "glsl/indirect/gather_parts.glsl"
#include "glsl/indirect/virtual_light.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(std430) readonly buffer VirtualLights { VirtualPointLight virtual_lights[]; };
#if ACCUMULATE
layout(rgba32f) uniform image2DArray gathered;
#else
layout(rgba32f) writeonly uniform image2DArray gathered;
#endif
uniform uint vpl_count;    // N
uniform uint batch_first;  // virtual lights that this pass may use
uniform uint batch_count;
uniform uint block;        // pixels
uniform float nearest;     // part of the scene's extent

// Whether the receiver (m; geometric normal) sees virtual light `vpl`: 1, or does not: 0. Asked only where it matters.
float vpl_visibility(uint vpl, vec3 receiver, vec3 normal);

struct Receiver {
  vec3 position;
  vec3 normal;            // shading
  vec3 geometric_normal;
  vec3 view;              // unit, to the viewer
  SurfaceBrdf brdf;
  float nearest;          // m
  float footprint;        // side of the pixel on the surface, m
};

struct Gathered {
  vec3 diffuse;   // per unit of the diffuse albedo, W/(sr m^2)
  vec3 specular;
  vec3 residual;  // of the diffuse part
};

void gather_from(uint vpl, Receiver r, inout Gathered sum) {
  VirtualPointLight light = virtual_lights[vpl];
  vec3 offset = light.position - r.position;
  float d2 = dot(offset, offset);
  vec3 l = offset * inversesqrt(d2);  // NaN at the light itself, where no comparison holds
  float cosines = dot(r.normal, l) * -dot(light.normal.xyz, l);
  bool lit = dot(r.normal, l) > 0.0 && dot(r.geometric_normal, l) > 0.0 && dot(light.normal.xyz, l) < 0.0 &&
             light.flux.x + light.flux.y + light.flux.z > 0.0;
  // A loop of at most one round: software renderers run both sides of an `if`, but leave a loop that nobody is in.
  while (lit) {
    lit = false;
    vec3 sent = light.flux.rgb * (inverse_pi * cosines * vpl_visibility(vpl, r.position, r.geometric_normal));
#if LAMBERTIAN
    float diffuse = inverse_pi;
#else
    BrdfParts parts = brdf_parts(r.brdf, r.normal, r.view, l);
    float diffuse = parts.diffuse;
    sum.specular += sent * parts.specular * bounded_inverse_square(d2, r.nearest);
#endif
    sum.diffuse += sent * (diffuse * bounded_inverse_square(d2, r.nearest));
#if GATHER_RESIDUAL
    sum.residual += sent * (diffuse * residual_inverse_square(d2, r.nearest, r.footprint));
#endif
  }
}

void store_part(ivec3 at, vec4 value) {
#if ACCUMULATE
  value.rgb += imageLoad(gathered, at).rgb;
#endif
  imageStore(gathered, at, value);
}

Receiver receiver_at(ivec2 pixel, float depth, GBufferSurface surface) {
  Receiver r;
  r.position = pixel_position(pixel, depth);
  r.normal = surface.normal;
  r.geometric_normal = surface.geometric_normal;
  r.view = normalize(frame.camera_position.xyz - r.position);
  r.brdf = surface_brdf(surface.base_colour, surface.metallic, surface.roughness, surface.specular_factor,
                        surface.specular_colour, surface.ior);
  r.nearest = nearest * gather_extent();
  r.footprint = depth * length(frame.view_ray_dx.xyz);
  return r;
}

void main() {
  uint sub_buffer = gl_WorkGroupID.z;
  ivec2 within = ivec2(sub_buffer % block, sub_buffer / block);
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy) * int(block) + within;
  uint first = max(gather_begin(sub_buffer, vpl_count, block), batch_first);
  uint end = min(gather_begin(sub_buffer + 1u, vpl_count, block), batch_first + batch_count);
  if (any(greaterThanEqual(pixel, ivec2(frame.frame_size)))) return;
#if SPLIT
  ivec2 texel = split_texel(pixel, int(block), ivec2(frame.frame_size));
#else
  ivec2 texel = pixel;
#endif
  float depth = pixel_depth(texel);
  GBufferSurface surface = pixel_surface(texel);
  bool covered = depth > 0.0 && (surface.flags & gbuffer_flag_specular) == 0u;
  Gathered sum = Gathered(vec3(0.0), vec3(0.0), vec3(0.0));
  if (covered && first < end) {
    Receiver r = receiver_at(pixel, depth, surface);
    uint i = first;
    do {  // the condition comes last: software renderers run a loop's body once more where it comes first
      gather_from(i, r, sum);
    } while (++i < end);
  }
  float scale = float(block * block);  // for the lights that other sub-buffers have
  float weight = covered ? 1.0 : 0.0;
  store_part(ivec3(texel, gather_part_diffuse), vec4(scale * sum.diffuse, weight));
#if GATHER_SPECULAR
  store_part(ivec3(texel, gather_part_specular), vec4(scale * sum.specular, weight));
#endif
#if GATHER_RESIDUAL
  store_part(ivec3(texel, gather_part_residual), vec4(scale * sum.residual, weight));
#endif
}

#endif  // LIMN_GATHER_MAIN_GLSL
