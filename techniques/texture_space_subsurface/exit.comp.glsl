// Adds the light that leaves bodies: F_t(n.v) B / (pi (1 - F_de)), with B between the texels around a pixel. Light of Gaussians
// that are narrower than texels is that of the pixel, and so is all light of bodies without charts. CHARTS 1: there are some with
// charts. TEXTURED 1: the albedo of a material may be that of the pixel. NORMALISED: see glsl/diffusion/profile.glsl.
#include "glsl/diffusion/pixel_exit.glsl"
#include "glsl/diffusion/profile.glsl"
#include "techniques/texture_space_subsurface/body_texture.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(std430) readonly buffer Instances { Instance instances[]; };
layout(std430) readonly buffer KindsOfMaterials { uint kinds_of_materials[]; };
layout(std430) readonly buffer Kinds { TexturedKind kinds[]; };
uniform sampler2D entering;  // E / pi
#if CHARTS
layout(std430) readonly buffer Gaussians { SurfaceGaussian gaussians[]; };
uniform sampler2D found;  // texels; layer; chart, 0: none
uniform sampler2DArray surface_frame;
uniform sampler2DArray entered;
uniform sampler2DArray leaving;
#endif
layout(rgba32f) uniform image2D radiance;

vec3 pixel_reflectance(TexturedKind kind, DiffusionBoundary boundary, ivec2 pixel) {
#if TEXTURED
  if (kind.textured != 0u) {
    vec3 albedo = gbuffer_colour_decode(texelFetch(gbuffer_albedo, pixel, 0).rgb);
    return profile_reflectance(albedo, boundary);
  }
#endif
  return kind.reflectance;
}

#if CHARTS
// The light around a pixel at this place of a texture, whose own light is `own`.
vec3 light_around(vec4 at, uint kind, vec3 own) {
  ivec2 last = textureSize(leaving, 0).xy - 1;
  vec2 start = floor(at.xy - 0.5);
  vec2 part = at.xy - 0.5 - start;
  vec3 spread = vec3(0.0);
  vec3 entry = vec3(0.0);
  vec2 size = vec2(0.0);
  float there = 0.0;
  for (int i = 0; i < 4; ++i) {
    ivec2 corner = ivec2(i & 1, i >> 1);
    ivec3 texel = ivec3(clamp(ivec2(start) + corner, ivec2(0), last), int(at.z));
    vec4 light = texelFetch(entered, texel, 0);
    if (light.w != at.w) continue;
    vec2 share = mix(1.0 - part, part, vec2(corner));
    float weight = share.x * share.y;
    entry += weight * light.rgb;
    spread += weight * texelFetch(leaving, texel, 0).rgb;
    size += weight * texelFetch(surface_frame, texel, 0).zw;
    there += weight;
  }
  if (there == 0.0) return own;
  vec3 rest = vec3(1.0);
  for (uint i = 0u; i < uint(GAUSSIANS); ++i) {
    SurfaceGaussian gaussian = gaussians[kind * uint(GAUSSIANS) + i];
    rest -= gaussian.weight * spread_share(gaussian.sigma, size / there);
  }
  rest = max(rest, vec3(0.0));
  return max(rest * own + (spread - rest * entry) / there, vec3(0.0));
}
#endif

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.frame_size)))) return;
  uint instance = pixel_instance(pixel);
  if (instance == no_instance) return;
  uint index = kinds_of_materials[instances[instance].material];
  if (index == no_kind) return;
  TexturedKind kind = kinds[index];
  vec3 light = texelFetch(entering, pixel, 0).rgb;
#if CHARTS
  vec4 at = texelFetch(found, pixel, 0);
  if (at.w != 0.0) light = light_around(at, index, light);
#endif
  DiffusionBoundary boundary = diffusion_boundary(kind.eta, kind.entering);
  vec3 leaving_here = pixel_reflectance(kind, boundary, pixel) * light * pixel_exit(pixel, boundary);
  imageStore(radiance, pixel, imageLoad(radiance, pixel) + vec4(leaving_here, 0.0));
}
