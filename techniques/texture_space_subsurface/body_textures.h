// Declares the translucent bodies of a scene, laid out in textures.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <vector>

#include "core/scene/deformed_surface.h"
#include "core/scene/diffusion_profile.h"
#include "core/scene/scene.h"
#include "techniques/texture_space_subsurface/body_texture.glsl"

namespace limn::texture_space {

/// Says which corners of BodyTextures::corners a body has.
struct CornerRange {
  uint32_t first = 0;
  uint32_t surroundings = 0;  ///< these come first, so that what charts have of their own lies over them
  uint32_t own = 0;
  double texel = 0;  ///< m: no texel gets smaller while fits() holds; 0: not known, the body deforms
};

/// Holds the layout of each translucent draw of a pose; draws without area have none.
struct BodyTextures {
  std::vector<glsl::ChartCorner> corners;
  std::vector<glsl::TexturedBody> bodies;
  std::vector<CornerRange> ranges;  ///< of each body
  size_t tooMany = 0;               ///< draws whose charts do not fit a texture, or whose triangles a buffer
};

/// Bounds the layers of textures.
struct TextureLimits {
  int64_t layers;      ///< that a device takes
  int64_t layerBytes;  ///< in one layer of all textures
};

/// Says what the layout of a translucent draw is made for.
struct LaidOutDraw {
  uint32_t draw;  ///< index into Pose::instances
  uint32_t kind;  ///< of its material
  std::shared_ptr<const scene::Primitive>
      source;  ///< of dynamic geometry, whose place is then not used again
  const scene::Primitive* primitive;
  bool mirrored;
  glm::dvec3 areas;                 ///< scene::areaFactors() of its matrix
  double area;                      ///< of all triangles that skins or morphs move, before its matrix; else 0
  scene::DeformedSurface deformed;  ///< its vertices in the pose that was asked for last, likewise
};

/// Holds what is known of the translucent materials that are drawn.
struct BodyMatter {
  std::vector<glsl::TexturedKind> kinds;
  std::vector<glsl::SurfaceGaussian> gaussians;  ///< `count` for each kind
  std::vector<double> reach;                     ///< of each kind's light, m
  std::vector<uint32_t> ofMaterials;             ///< index into `kinds`, glsl::no_kind
  bool textured = false;
};

/// Returns the kinds of the translucent materials that a pose draws, as sums of `count` Gaussians.
BodyMatter bodyMatter(const scene::Scene& scene, const scene::Pose& pose, bool normalised, int count);

/// Returns the translucent draws of a pose.
std::vector<LaidOutDraw> translucentDraws(const scene::Scene& scene, const scene::Pose& pose,
                                          const BodyMatter& matter);

/// Returns whether the layouts of draws still serve at another pose with as many instances: none has other
/// triangles, is mirrored or has areas that its matrix, or a whole area that skins or morphs, changed by more
/// than half. Moves their vertices to that pose.
bool fits(const scene::Pose& pose, std::span<LaidOutDraw> draws);

/// Returns the first of a kind's `count` Gaussians that is spread in a texel of any body: half as wide as it
/// or wider. `count`: none.
int firstSpread(const BodyTextures& textures, const BodyMatter& matter, int count);

/// Throws UsageError for more bodies than textures of `texels` x `texels` may have layers.
void checkLayers(const BodyTextures& textures, int texels, const TextureLimits& limits);

/// Returns the layouts of draws, which were made for that pose, in textures of `texels` x `texels`, with
/// corners that take `cornerBytes` at most.
BodyTextures bodyTextures(const scene::Pose& pose, std::span<const LaidOutDraw> draws,
                          const BodyMatter& matter, int texels, int64_t cornerBytes);

}  // namespace limn::texture_space
