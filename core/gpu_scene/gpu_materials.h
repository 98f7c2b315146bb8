// Declares the materials, textures and samplers of a GpuScene.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/gpu/objects.h"
#include "core/gpu_scene/gpu_scene.h"
#include "core/scene/scene.h"

namespace limn::scene {

class GpuMaterials {
 public:
  GpuMaterials(gpu::Device& device, const Scene& scene);

  /// Adopts emissions that changed; everything else of a material is fixed. Returns true if any changed.
  bool update(const Scene& scene);
  const gpu::Buffer& constants() const { return constants_; }
  /// Returns the model of each material (of kind model_none where it has none); empty where none has one.
  const gpu::Buffer& models() const { return models_; }
  /// Returns the values of Scene::measured, three floats each; empty where there are none.
  const gpu::Buffer& measured() const { return measured_; }
  /// Returns bit 1 << kind of each model.
  uint32_t modelKinds() const { return modelKinds_; }
  /// Returns a key that is equal for materials that bind the same textures; 0 means no textures.
  uint32_t textureKey(int material) const { return sets_[static_cast<size_t>(material)].key; }
  /// Returns such a key for the base colour texture alone, which is all that an alpha test needs.
  uint32_t baseColourKey(int material) const { return sets_[static_cast<size_t>(material)].baseColourKey; }
  SurfaceVariant variant(int material) const { return sets_[static_cast<size_t>(material)].variant; }
  /// Names of a material's textures in the shaders.
  static constexpr std::array<const char*, 5> textureNames{
      "base_colour_texture", "metal_rough_texture", "normal_texture", "emissive_texture", "height_slopes"};
  /// Binds the material and its textures to the slots of `programs`.
  void bind(const frame::PassContext& context, const SurfacePrograms& programs, int material) const;
  /// Binds the material's base colour texture alone to `slot`.
  void bindBaseColour(const frame::PassContext& context, frame::SlotHandle slot, int material) const;
  bool masked(int material) const { return variant(material).masked; }
  bool specular(int material) const { return sets_[static_cast<size_t>(material)].specular; }
  bool doubleSided(int material) const { return sets_[static_cast<size_t>(material)].doubleSided; }

 private:
  void makeBlocks();
  void makeModels(const Scene& scene);
  void bindTexture(const frame::PassContext& context, frame::SlotHandle slot, int material,
                   size_t texture) const;

  using Choice = std::array<int, textureNames.size()>;
  struct Set {
    Choice textures{kNone, kNone, kNone, kNone, kNone};  ///< of textures_
    Choice samplers{};
    uint32_t key = 0, baseColourKey = 0;
    SurfaceVariant variant;
    bool doubleSided = false, specular = false;
  };
  gpu::Device& device_;
  std::vector<glsl::Material> materials_;
  gpu::Buffer constants_;
  gpu::Buffer models_;
  gpu::Buffer measured_;
  uint32_t modelKinds_ = 0;
  gpu::Buffer blocks_;      ///< the same data, each at the alignment of a uniform block
  size_t blockStride_ = 0;  ///< bytes
  /// Holds those of Scene::images, then the slopes of Scene::heights; empty where no material binds them.
  std::vector<gpu::Texture> textures_;
  std::vector<gpu::Sampler> samplers_;  ///< 3 x wrapS + wrapT
  std::vector<Set> sets_;
};

}  // namespace limn::scene
