// What the camera sees before any light is added: emission of surfaces, the environment behind them and, where there
// are specular surfaces (SPECULAR), in them.
#include "glsl/surface/gbuffer_input.glsl"
#include "glsl/numeric/equirectangular.glsl"
#include "glsl/caustics/specular_view.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba32f) writeonly uniform image2D radiance;
#if ENVIRONMENT
uniform sampler2D environment_map;
#endif
#if SPECULAR
layout(std430) readonly buffer Instances { Instance instances[]; };
layout(std430) readonly buffer Materials { Material materials[]; };
#endif

// direction: unit.
vec3 environment_radiance(vec3 direction) {
#if ENVIRONMENT
  vec2 uv = equirectangular_uv(environment_lookup_direction(direction, frame.environment_rotation));
  return frame.environment_scale * textureLod(environment_map, uv, 0.0).rgb;
#else
  return vec3(0.0);
#endif
}

#if SPECULAR
vec3 seen_in_surface(ivec2 pixel) {
  GBufferSurface s = pixel_surface(pixel);
  if ((s.flags & gbuffer_flag_specular) == 0u) return vec3(0.0);
  Instance instance = instances[pixel_instance(pixel)];
  Material material = materials[instance.material];
  SurfaceBrdf surface =
      surface_brdf(s.base_colour, s.metallic, s.roughness, s.specular_factor, s.specular_colour, s.ior);
  SpecularView seen = specular_view(surface, s.base_colour, s.metallic, material.transmission, s.ior,
                                    material.thickness * body_scale(mat3(instance.object_to_world)), material.attenuation,
                                    material.attenuation_distance, s.normal, -normalize(pixel_ray(pixel)));
  return seen.reflected * environment_radiance(seen.reflection) +
         seen.transmitted * environment_radiance(seen.refraction);
}
#endif

vec3 light_seen(ivec2 pixel) {
#if GEOMETRY
  if (pixel_depth(pixel) > 0.0) {
    vec3 light = texelFetch(gbuffer_emission, pixel, 0).rgb;
#if SPECULAR
    light += seen_in_surface(pixel);
#endif
    return light;
  }
#endif
  return environment_radiance(normalize(pixel_ray(pixel)));
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.frame_size)))) return;
  imageStore(radiance, pixel, vec4(light_seen(pixel), 1.0));
}
