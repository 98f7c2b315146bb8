// Materials, textures and samplers of a GpuScene.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/gpu/objects.h"
#include "core/scene/gpu_scene.h"
#include "core/scene/scene.h"

namespace limn::scene {

class GpuMaterials {
 public:
  GpuMaterials(gpu::Device& device, const Scene& scene);

  /// Takes over emissions that changed; everything else of a material is fixed. True if any did.
  bool update(const Scene& scene);
  const gpu::Buffer& constants() const { return constants_; }
  /// Materials with equal keys bind the same textures; 0: none at all.
  uint32_t textureKey(int material) const { return sets_[static_cast<size_t>(material)].key; }
  /// The same for the base colour alone, all that an alpha test needs.
  uint32_t baseColourKey(int material) const { return sets_[static_cast<size_t>(material)].baseColourKey; }
  SurfaceVariant variant(int material) const { return sets_[static_cast<size_t>(material)].variant; }
  /// Units 0 to 3: base colour, metal-rough, normal, emissive. Uniform block 1: its glsl::Material.
  void bind(int material) const;
  /// Unit 0: base colour.
  void bindBaseColour(int material) const;
  bool masked(int material) const { return variant(material).masked; }
  bool specular(int material) const { return sets_[static_cast<size_t>(material)].specular; }
  bool doubleSided(int material) const { return sets_[static_cast<size_t>(material)].doubleSided; }

 private:
  void makeBlocks();

  struct Set {
    std::array<int, 4> textures{none, none, none, none}, samplers{};
    uint32_t key = 0, baseColourKey = 0;
    SurfaceVariant variant;
    bool doubleSided = false, specular = false;
  };
  gpu::Device& device_;
  std::vector<glsl::Material> materials_;
  gpu::Buffer constants_;
  gpu::Buffer blocks_;      ///< the same, each where a uniform block may begin
  size_t blockStride_ = 0;  ///< bytes
  std::vector<gpu::Texture> textures_;
  std::vector<gpu::Sampler> samplers_;  ///< 3 x wrapS + wrapT
  std::vector<Set> sets_;
};

}  // namespace limn::scene
