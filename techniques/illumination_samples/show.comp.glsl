// Light at a pixel: the diffuse part reflects the irradiance of the leaves around it, and the specular part is, by DISPLAY,
// 0: what these leaves' trees send towards the eye, 1: the same, looked up for each leaf before, 2: what the pixel's own
// material reflects of their samples.
#include "glsl/indirect/sample_reflection.glsl"
#include "glsl/indirect/surface_leaf.glsl"
#include "glsl/indirect/surface_lookup.glsl"
#include "glsl/surface/gbuffer_input.glsl"
#if DISPLAY == 0
#include "techniques/illumination_samples/leaf_tree.glsl"
#endif

layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba32f) uniform image2D radiance;
layout(std430) readonly buffer Irradiance { vec4 irradiance[]; };

struct Pixel {
  vec3 position;
  vec3 normal;
  vec3 geometric_normal;
  vec3 view;  // unit, to the eye
  SurfaceBrdf material;
};

#if DISPLAY == 0

vec3 specular(Pixel at, Around a) {
  vec3 sum = vec3(0.0);
  for (int k = 0; k < 3; ++k)
    if (a.weights[k] > 0.0) sum += a.weights[k] * leaf_radiance(a.slots[k], at.view);
  return sum;
}

#elif DISPLAY == 1

layout(std430) readonly buffer Towards { vec4 towards[]; };  // radiance of leaves towards the eye

vec3 specular(Pixel at, Around a) {
  return a.weights.x * towards[a.slots.x].rgb + a.weights.y * towards[a.slots.y].rgb +
         a.weights.z * towards[a.slots.z].rgb;
}

#else

layout(std430) readonly buffer Ranges { uvec2 ranges[]; };  // of elements: the first sample, and how many
layout(std430) readonly buffer Samples { IlluminationSample samples[]; };
layout(std430) readonly buffer Senders { SampleSender senders[]; };
layout(std430) readonly buffer Parents { uint parents[]; };  // of groups of four elements
layout(std430) readonly buffer Leaves { Leaf leaves[]; };
uniform float widen;

const uint nobody = 0xffffffffu;

// Samples that span more are taken from the leaf, radians: what stands for the shapes of elements leaves gaps that a pixel
// beside a wall would look through.
const float near_spread = 0.5;

// Of the others, those that span more of the lobe's width than this are reflected in their whole extent.
const float narrow_lobe = 1.0;

// Sum over the samples of one element, of which a leaf around the pixel is a part.
vec3 reflected(Pixel at, uint element, uint leaf) {
  uvec2 range = ranges[element];
  vec3 sum = vec3(0.0);
  for (uint i = range.x; i < range.x + range.y; ++i) {
    IlluminationSample from = samples[i];
    SampleSender sender = senders[from.sender];
    IncidentLight light = incident_light(sender, from.radiance, at.position);
    bool near = light.spread > near_spread;
    if (near) light = incident_light(sender, from.radiance, leaves[leaf].position.xyz);
    float n_dot_l = max(dot(light.direction, at.normal), 0.0);
    if (!near && widen > 0.0 && light.spread > narrow_lobe * at.material.alpha * n_dot_l)
      sum += reflected_extent(at.material, at.position, at.normal, at.geometric_normal, at.view, sender, from.radiance);
    else if (dot(light.direction, at.geometric_normal) > 0.0)
      sum += reflected_specular(at.material, at.normal, at.view, light, widen);
  }
  return sum;
}

vec3 specular(Pixel at, Around a) {
  // The elements above the three leaves soon are the same ones.
  uvec3 elements = a.slots;
  vec3 weights = a.weights;
  vec3 sum = vec3(0.0);
  while (weights != vec3(0.0)) {
    if (elements.z == elements.y) weights = vec3(weights.x, weights.y + weights.z, 0.0);
    if (elements.y == elements.x) weights = vec3(weights.x + weights.y, 0.0, weights.z);
    if (elements.z == elements.x) weights = vec3(weights.x + weights.z, weights.y, 0.0);
    for (int k = 0; k < 3; ++k) {
      if (weights[k] == 0.0) continue;
      sum += weights[k] * reflected(at, elements[k], a.slots[k]);
      elements[k] = parents[elements[k] / 4u];
      if (elements[k] == nobody) weights[k] = 0.0;
    }
  }
  return sum;
}

#endif

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.frame_size)))) return;
  float depth = pixel_depth(pixel);
  if (depth == 0.0) return;
  GBufferSurface surface = pixel_surface(pixel);
  if ((surface.flags & gbuffer_flag_specular) != 0u) return;
  Around a = around_pixel(pixel);
  if (!a.found) return;
  Pixel at;
  at.position = pixel_position(pixel, depth);
  at.normal = surface.normal;
  at.geometric_normal = surface.geometric_normal;
  at.view = -normalize(pixel_ray(pixel));
  at.material = surface_brdf(surface.base_colour, surface.metallic, surface.roughness, surface.specular_factor,
                             surface.specular_colour, surface.ior);
  vec3 light = a.weights.x * irradiance[a.slots.x].rgb + a.weights.y * irradiance[a.slots.y].rgb +
               a.weights.z * irradiance[a.slots.z].rgb;
  vec3 sum = diffuse_albedo(at.material) * light * inverse_pi;
  if (!brdf_is_lambertian(at.material)) sum += specular(at, a);
  imageStore(radiance, pixel, imageLoad(radiance, pixel) + vec4(sum, 0.0));
}
