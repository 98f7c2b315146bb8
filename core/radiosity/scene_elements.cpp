#include "core/radiosity/scene_elements.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/scene/deformed_surface.h"
#include "core/scene/draw_instance.h"
#include "core/scene/instance_areas.h"
#include "core/scene/normal_matrix.h"
#include "core/scene/texture_lookup.h"
#include "glsl/surface/reflectance.glsl"

namespace limn::radiosity {

/// One instance's vertices in world space.
struct SceneElements::Instance {
  const scene::Primitive* primitive = nullptr;
  /// The same of geometry sources, which fill again what nobody holds.
  std::shared_ptr<const scene::Primitive> held;
  int material = 0;
  bool mirrored = false;
  glm::dvec3 areas{0};  ///< factors by which the matrix changed areas when the elements were made
  double madeArea = 0;  ///< of deformed instances, before the matrix, when the elements were made
  /// Holds those of the pose that was asked for last: fits() and then update() ask for that of a frame.
  mutable scene::DeformedSurface deformed;
  std::vector<glm::vec3> positions, normals;

  const scene::DeformedSurface& deformedIn(const scene::Pose& pose, const scene::DrawInstance& draw) const {
    deformed.move(*primitive, pose.deformed[static_cast<size_t>(draw.deformed)]);
    return deformed;
  }

  void move(const scene::Pose& pose, const scene::DrawInstance& draw) {
    const scene::DeformedSurface* moved = draw.deformed != scene::kNone ? &deformedIn(pose, draw) : nullptr;
    positions = moved ? moved->positions() : primitive->positions;
    normals = moved ? moved->normals() : primitive->normals;
    const glm::mat4& matrix = draw.objectToWorld;
    mirrored = scene::mirrored(draw);
    const glm::mat3 toNormal = scene::normalMatrix(matrix);
    tbb::parallel_for(size_t{0}, positions.size(), [&](size_t i) {
      positions[i] = glm::vec3(matrix * glm::vec4(positions[i], 1.f));
      const glm::vec3 n = toNormal * normals[i];
      const float length = glm::length(n);
      if (length > 0) normals[i] = n / length;
    });
  }

  /// Whether a skin or morph targets leave the area nearly as it was when the elements were made.
  bool keepsArea(const scene::Pose& pose, const scene::DrawInstance& draw) const {
    if (draw.deformed == scene::kNone) return true;
    return scene::areasAlike(glm::dvec3(deformedIn(pose, draw).area()), glm::dvec3(madeArea));
  }
};

SceneElements::SceneElements(const scene::Scene& scene, const scene::Pose& pose, float longestEdge,
                             uint32_t maxElements, double lift, LeafShape shape)
    : scene_(scene), space_(pose.bounds.centre(), pose.bounds.radius()) {
  uint64_t triangles = 0;
  for (const scene::DrawInstance& draw : pose.instances) {
    Instance& instance = instances_.emplace_back();
    instance.primitive = &scene::primitiveOf(scene, pose, draw);
    instance.material = scene::materialIndexOf(scene, draw);
    if (draw.node == scene::kNone) instance.held = pose.dynamic[static_cast<size_t>(draw.mesh)].primitive;
    instance.areas = scene::areaFactors(draw.objectToWorld);
    triangles += instance.primitive->indices.size() / 3;
  }
  const auto refuse = [&](const std::string& what) {
    throw UsageError(
        fmt::format("surface elements: {}; at most {} of them fit the memory allowed", what, maxElements));
  };
  // A closed mesh has half as many vertices as triangles.
  if (triangles / 4 > maxElements) refuse(fmt::format("the scene has {} triangles", triangles));
  moveInstances(pose);
  for (Instance& instance : instances_) instance.madeArea = instance.deformed.area();
  std::vector<TriangleMesh> meshes(instances_.size());
  for (size_t i = 0; i < instances_.size(); ++i) {
    const Instance& instance = instances_[i];
    TriangleMesh& mesh = meshes[i];
    for (const glm::vec3& p : instance.positions) mesh.positions.push_back(space_.point(p));
    for (const glm::vec3& n : instance.normals) mesh.normals.push_back(space_.direction(n));
    mesh.uvs = instance.primitive->uvs;
    mesh.indices = instance.primitive->indices;
    if (instance.mirrored)
      for (size_t t = 0; t + 2 < mesh.indices.size(); t += 3)
        std::swap(mesh.indices[t + 1], mesh.indices[t + 2]);
    mesh.doubleSided = scene.materials[static_cast<size_t>(instance.material)].doubleSided;
  }
  surfels_ = createSurfels(meshes, longestEdge, lift, maxElements);
  bodies_ = Bodies(surfels_, lift);
  forest_ = Forest(surfels_, shape);
  // Small clusters do not fill their groups of four, and memory is taken for every slot.
  if (forest_.leafSlots() > maxElements)
    refuse(fmt::format("the scene's {} take the slots of {}", surfels_.size(), forest_.leafSlots()));
  leaves_.resize(forest_.leafSlots());
  materials_.resize(forest_.leafSlots());
  setMaterials();
  moveSurfels();
}

SceneElements::~SceneElements() = default;

bool SceneElements::fits(const scene::Pose& pose, std::span<const scene::DrawInstance> instances) const {
  const auto same = [&](const scene::DrawInstance& now, const Instance& known) {
    return &scene::primitiveOf(scene_, pose, now) == known.primitive &&
           scene::mirrored(now) == known.mirrored &&
           scene::areasAlike(scene::areaFactors(now.objectToWorld), known.areas) &&
           known.keepsArea(pose, now);
  };
  return std::ranges::equal(instances, instances_, same);
}

void SceneElements::update(const scene::Pose& pose) {
  moveInstances(pose);
  moveSurfels();
  forest_.refit(surfels_);
}

void SceneElements::moveInstances(const scene::Pose& pose) {
  for (size_t i = 0; i < instances_.size(); ++i) instances_[i].move(pose, pose.instances[i]);
}

void SceneElements::moveSurfels() {
  tbb::parallel_for(size_t{0}, surfels_.size(), [&](size_t i) {
    Leaf& leaf = leaves_[forest_.leafOf()[i]];
    const Instance& instance = instances_[surfels_.objects[i]];
    const auto blend = [&](const SurfelOrigin& o, const std::vector<glm::vec3>& values) {
      return o.weights.x * values[o.vertices[0]] + o.weights.y * values[o.vertices[1]] +
             o.weights.z * values[o.vertices[2]];
    };
    glm::vec3 normal(0);
    for (uint32_t k = surfels_.firstOrigin[i]; k < surfels_.firstOrigin[i + 1]; ++k)
      normal += surfels_.origins[k].side * blend(surfels_.origins[k], instance.normals);
    const float length = glm::length(normal);
    if (length > 0) surfels_.normals[i] = space_.direction(normal / length);
    const glm::vec3 vertex = blend(surfels_.origins[surfels_.firstOrigin[i]], instance.positions);
    surfels_.vertices[i] = space_.point(vertex);
    leaf.vertex = vertex;
    leaf.used = 1;
  });
  tbb::parallel_for(size_t{0}, surfels_.size(), [&](size_t i) {
    surfels_.positions[i] = surfels_.centre(i, surfels_.vertices, surfels_.normals[i]);
  });
  bodies_.leave(surfels_);
  tbb::parallel_for(size_t{0}, surfels_.size(), [&](size_t i) {
    Leaf& leaf = leaves_[forest_.leafOf()[i]];
    leaf.position = glm::vec4(space_.worldPoint(surfels_.positions[i]), 1);
    leaf.normal = glm::vec4(space_.worldDirection(surfels_.normals[i]), 0);
  });
}

void SceneElements::setMaterials() {
  for (size_t i = 0; i < surfels_.size(); ++i) {
    const Instance& instance = instances_[surfels_.objects[i]];
    const scene::Primitive& primitive = *instance.primitive;
    const scene::Material& material = scene_.materials[static_cast<size_t>(instance.material)];
    if (material.specularSurface()) continue;
    const SurfelOrigin& o = surfels_.origins[surfels_.firstOrigin[i]];
    const auto blend = [&](const auto& values) {
      return o.weights.x * values[o.vertices[0]] + o.weights.y * values[o.vertices[1]] +
             o.weights.z * values[o.vertices[2]];
    };
    glm::vec4 base = material.baseColour, metalRough(1);
    // Vertices and textures decide on a model's coverage alone.
    const bool coloured = !material.model;
    if (coloured && !primitive.colours.empty()) base *= blend(primitive.colours);
    if (!primitive.uvs.empty()) {
      // The level whose texels are as large as the disc: from the triangle's area in the texture and in
      // space.
      const auto areaOf = [&](const auto& a, const auto& b) {
        return glm::length(glm::cross(glm::vec3(a), glm::vec3(b)));
      };
      const auto& p = instance.positions;
      const auto& uv = primitive.uvs;
      const float space = areaOf(p[o.vertices[1]] - p[o.vertices[0]], p[o.vertices[2]] - p[o.vertices[0]]);
      const float plane = areaOf(glm::vec3(uv[o.vertices[1]] - uv[o.vertices[0]], 0),
                                 glm::vec3(uv[o.vertices[2]] - uv[o.vertices[0]], 0));
      const float disc = surfels_.areas[i] * space_.radius() * space_.radius();
      const auto lookup = [&](const scene::TextureRef& texture) {
        const glm::vec2 size = scene::textureSize(scene_, texture);
        const float texels = plane / std::max(space, 1e-30f) * disc * size.x * size.y;
        return scene::sampleTexture(scene_, texture, blend(uv), 0.5f * std::log2(std::max(texels, 1.f)));
      };
      if (coloured) base *= lookup(material.baseColourTexture);
      metalRough = lookup(material.metalRoughTexture);
    }
    const glsl::SurfaceBrdf brdf = glsl::surface_brdf(
        glm::clamp(glm::vec3(base), 0.f, 1.f), glm::clamp(material.metallic * metalRough.b, 0.f, 1.f),
        glm::clamp(material.roughness * metalRough.g, 0.f, 1.f),
        glm::clamp(material.specularFactor, 0.f, 1.f), glm::clamp(material.specularColour, 0.f, 1.f),
        material.ior);
    const uint32_t leaf = forest_.leafOf()[i];
    leaves_[leaf].albedo = glsl::hemispherical_reflectance(brdf);
    materials_[leaf].brdf = brdf;
  }
}

}  // namespace limn::radiosity
