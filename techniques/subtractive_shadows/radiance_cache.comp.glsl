// The radiance cache: light of the environment that the lobes of materials reflect, by normal, for one view. Each material has two
// layers, those of LobeLight; of one with a model what its lobe reflects, and its diffuse part unless that is Lambertian.
#include "techniques/subtractive_shadows/cache_view.glsl"
#include "techniques/subtractive_shadows/lobe_light.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba32f) writeonly uniform image2DArray radiance_cache;
layout(std430) readonly buffer Materials { Material materials[]; };
layout(std430) readonly buffer CachedMaterials { uint cached_materials[]; };

void main() {
  ivec3 texel = ivec3(gl_GlobalInvocationID);
  vec3 v = cache_view();
  vec3 n = cache_normal(texel.xy, v, cache_view_reach());
  uint index = cached_materials[texel.z];
  ivec3 first = ivec3(texel.xy, 2 * texel.z), second = first + ivec3(0, 0, 1);
#if MATERIAL_MODELS
  SurfaceMaterial own;
  own.model = material_models[index];
  if (has_model(own)) {
    ReflectedParts light = sampled_model(own, n, n, v, vec3(0.0));
    imageStore(radiance_cache, first, vec4(light.lobe, 0.0));
    imageStore(radiance_cache, second, vec4(light.diffuse, 0.0));
    return;
  }
#endif
  float roughness = materials[index].roughness;
  LobeLight light = sampled_lobe(max(roughness * roughness, brdf_min_alpha), n, n, v, brdf_samples);
  imageStore(radiance_cache, first, vec4(light.facing, 0.0));
  imageStore(radiance_cache, second, vec4(light.grazing, 0.0));
}
