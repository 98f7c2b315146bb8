#include "core/gpu_scene/gpu_materials.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <map>

#include "core/relief/slopes.h"
#include "core/scene/texture_lookup.h"
#include "glsl/scene/blocks.glsl"

namespace limn::scene {
namespace {

glsl::Material packConstants(const Scene& scene, const Material& m) {
  glsl::Material out{};
  out.base_colour = m.baseColour;
  out.emission = m.emission;
  out.alpha_cutoff = m.alphaCutoff;
  out.metallic = m.metallic;
  out.roughness = m.roughness;
  out.normal_scale = m.normalScale;
  out.ior = m.ior;
  out.specular_colour = m.specularColour * m.specularFactor;
  out.specular_factor = m.specularFactor;
  out.transmission = m.transmission;
  out.thickness = m.thickness;
  out.attenuation_distance = m.attenuationDistance;
  out.attenuation = m.attenuationColour;
  uint32_t flags = 0;
  if (m.doubleSided) flags |= glsl::material_double_sided;
  if (m.unlit) flags |= glsl::material_unlit;
  if (m.baseColourTexture.image != kNone) flags |= glsl::material_has_base_colour_texture;
  if (m.metalRoughTexture.image != kNone) flags |= glsl::material_has_metal_rough_texture;
  if (m.normalTexture.image != kNone) flags |= glsl::material_has_normal_texture;
  if (m.emissiveTexture.image != kNone) flags |= glsl::material_has_emissive_texture;
  if (m.specularSurface()) flags |= glsl::material_specular_surface;
  if (m.model) flags |= glsl::material_has_model;
  if (m.subsurface) flags |= glsl::material_translucent;
  if (m.height != kNone && m.normalTexture.image == kNone) flags |= glsl::material_has_height_normals;
  out.height = m.height;
  if (m.height != kNone) {
    const relief::HeightField& field = scene.heights[static_cast<size_t>(m.height)];
    out.height_size = glm::uvec2(field.size());
    if (field.wrap() == relief::Wrap::clamped) flags |= glsl::material_height_clamped;
  }
  out.flags = flags;
  return out;
}

/// `fine`: filtered with more than 8 bits. Software renderers filter RGBA8 in 8-bit fixed point, which turns
/// a normal map by 0.2 degrees in the mean; hardware does not.
gpu::Texture upload(gpu::Device& device, const TextureImage& image, bool fine) {
  const GLenum linear = fine && device.software() ? GL_RGBA16 : GL_RGBA8;
  gpu::Texture texture(device, image.name,
                       {.target = GL_TEXTURE_2D,
                        .format = image.srgb ? GLenum{GL_SRGB8_ALPHA8} : linear,
                        .width = image.levels[0].width,
                        .height = image.levels[0].height,
                        .levels = static_cast<int>(image.levels.size())});
  for (size_t level = 0; level < image.levels.size(); ++level)
    texture.upload(static_cast<int>(level), 0, GL_RGBA, GL_UNSIGNED_BYTE, image.levels[level].rgba.data());
  return texture;
}

gpu::Texture upload(gpu::Device& device, const relief::HeightField& field) {
  const std::vector<relief::SlopeLevel> levels = relief::slopeLevels(field);
  gpu::Texture texture(device, "height slopes",
                       {.target = GL_TEXTURE_2D,
                        .format = GL_RG32F,
                        .width = field.size().x,
                        .height = field.size().y,
                        .levels = static_cast<int>(levels.size())});
  for (size_t level = 0; level < levels.size(); ++level)
    texture.upload(static_cast<int>(level), 0, GL_RG, GL_FLOAT, levels[level].slopes.data());
  return texture;
}

constexpr uint32_t kTextureFlags = glsl::material_has_base_colour_texture |
                                   glsl::material_has_metal_rough_texture |
                                   glsl::material_has_normal_texture | glsl::material_has_emissive_texture |
                                   glsl::material_has_height_normals;

constexpr std::array<GLint, 3> kWraps{GL_REPEAT, GL_CLAMP_TO_EDGE, GL_MIRRORED_REPEAT};

int samplerOf(Wrap wrapS, Wrap wrapT) {
  return 3 * static_cast<int>(wrapS) + static_cast<int>(wrapT);
}

}  // namespace

GpuMaterials::GpuMaterials(gpu::Device& device, const Scene& scene) : device_(device) {
  std::map<std::pair<Choice, Choice>, uint32_t> keys{{{Set().textures, Set().samplers}, 0u}};
  const auto keyOf = [&](const Choice& textures, const Choice& samplers) {
    return keys.emplace(std::pair(textures, samplers), static_cast<uint32_t>(keys.size())).first->second;
  };
  for (const Material& material : scene.materials) {
    materials_.push_back(packConstants(scene, material));
    Set set;
    const std::array<const TextureRef*, 4> refs{&material.baseColourTexture, &material.metalRoughTexture,
                                                &material.normalTexture, &material.emissiveTexture};
    for (size_t i = 0; i < refs.size(); ++i) {
      if (refs[i]->image == kNone) continue;
      set.textures[i] = refs[i]->image;
      set.samplers[i] = samplerOf(refs[i]->wrapS, refs[i]->wrapT);
    }
    if ((materials_.back().flags & glsl::material_has_height_normals) != 0) {
      const Wrap wrap = wrapOf(scene.heights[static_cast<size_t>(material.height)]);
      set.textures.back() = static_cast<int>(scene.images.size()) + material.height;
      set.samplers.back() = samplerOf(wrap, wrap);
    }
    set.key = keyOf(set.textures, set.samplers);
    set.baseColourKey = keyOf({set.textures[0], kNone, kNone, kNone, kNone}, {set.samplers[0], 0, 0, 0, 0});
    set.variant = {materials_.back().flags & kTextureFlags, material.alphaCutoff > 0};
    set.doubleSided = material.doubleSided;
    set.specular = material.specularSurface();
    sets_.push_back(set);
  }
  constants_ = gpu::Buffer::of<glsl::Material>(device, "materials", materials_, gpu::BufferUse::updated);
  makeBlocks();
  makeModels(scene);
  std::vector<bool> isNormalMap(scene.images.size());
  for (const Material& material : scene.materials)
    if (material.normalTexture.image != kNone)
      isNormalMap[static_cast<size_t>(material.normalTexture.image)] = true;
  std::vector<bool> isBound(scene.images.size() + scene.heights.size());
  for (const Set& set : sets_)
    for (const int texture : set.textures)
      if (texture != kNone) isBound[static_cast<size_t>(texture)] = true;
  // What no material binds is what lights shine through, or that of which another image was made.
  for (size_t i = 0; i < isBound.size(); ++i) {
    if (!isBound[i])
      textures_.emplace_back();
    else if (i < scene.images.size())
      textures_.push_back(upload(device, scene.images[i], isNormalMap[i]));
    else
      textures_.push_back(upload(device, scene.heights[i - scene.images.size()]));
  }
  if (textures_.empty()) return;
  for (const GLint wrapS : kWraps) {
    for (const GLint wrapT : kWraps) {
      gpu::Sampler& sampler = samplers_.emplace_back(device, GL_LINEAR_MIPMAP_LINEAR, GL_LINEAR);
      device.gl().SamplerParameteri(sampler.id(), GL_TEXTURE_WRAP_S, wrapS);
      device.gl().SamplerParameteri(sampler.id(), GL_TEXTURE_WRAP_T, wrapT);
    }
  }
}

void GpuMaterials::makeBlocks() {
  const auto step = static_cast<size_t>(device_.limits().uniformAlignment);
  blockStride_ = (sizeof(glsl::Material) + step - 1) / step * step;
  std::vector<std::byte> bytes(std::max<size_t>(materials_.size(), 1) * blockStride_);
  for (size_t i = 0; i < materials_.size(); ++i)
    std::memcpy(bytes.data() + i * blockStride_, &materials_[i], sizeof(glsl::Material));
  blocks_ = gpu::Buffer(device_, "material blocks", bytes.size(), gpu::BufferUse::updated, bytes.data());
}

void GpuMaterials::makeModels(const Scene& scene) {
  std::vector<glsl::MaterialModel> models;
  for (const Material& material : scene.materials) {
    models.push_back(material.model.value_or(glsl::MaterialModel{}));
    models.back().material = static_cast<uint32_t>(models.size() - 1);
    if (material.model) modelKinds_ |= 1u << material.model->kind;
  }
  if (modelKinds_ != 0)
    models_ = gpu::Buffer::of<glsl::MaterialModel>(device_, "material models", models, gpu::BufferUse::fixed);
  if (!scene.measured.empty())
    measured_ =
        gpu::Buffer::of<glm::vec3>(device_, "measured reflectance", scene.measured, gpu::BufferUse::fixed);
}

bool GpuMaterials::update(const Scene& scene) {
  bool any = false;
  for (size_t i = 0; i < materials_.size(); ++i) {
    const glm::vec3& emission = scene.materials[i].emission;
    if (materials_[i].emission == emission) continue;
    materials_[i].emission = emission;
    constants_.update(i * sizeof(glsl::Material), &materials_[i], sizeof(glsl::Material));
    blocks_.update(i * blockStride_, &materials_[i], sizeof(glsl::Material));
    any = true;
  }
  return any;
}

void GpuMaterials::bindTexture(const frame::PassContext& context, frame::SlotHandle slot, int material,
                               size_t texture) const {
  const Set& set = sets_[static_cast<size_t>(material)];
  if (set.textures[texture] == kNone) return;
  context.bind(slot, textures_[static_cast<size_t>(set.textures[texture])],
               &samplers_[static_cast<size_t>(set.samplers[texture])]);
}

void GpuMaterials::bind(const frame::PassContext& context, const SurfacePrograms& programs,
                        int material) const {
  context.bind(programs.material, blocks_, static_cast<size_t>(material) * blockStride_,
               sizeof(glsl::Material));
  for (size_t i = 0; i < programs.textures.size(); ++i)
    bindTexture(context, programs.textures[i], material, i);
}

void GpuMaterials::bindBaseColour(const frame::PassContext& context, frame::SlotHandle slot,
                                  int material) const {
  bindTexture(context, slot, material, 0);
}

}  // namespace limn::scene
