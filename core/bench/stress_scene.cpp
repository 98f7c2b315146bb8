#include "core/bench/private/stress_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/scene/density_grid.h"
#include "core/scene/material_model.h"
#include "core/scene/subsurface.h"

namespace limn::bench {
namespace {

/// Triangles in world space that never change.
class FixedGeometry : public scene::GeometrySource {
 public:
  explicit FixedGeometry(const std::vector<glm::vec3>& corners) {
    primitive_->positions = corners;
    for (uint32_t i = 0; i < corners.size(); ++i) primitive_->indices.push_back(i);
    for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
      const glm::vec3 n = glm::cross(corners[i + 1] - corners[i], corners[i + 2] - corners[i]);
      const float length = glm::length(n);
      // Triangles without area get some unit normal: it is their area that is the difficulty.
      primitive_->normals.insert(primitive_->normals.end(), 3, length > 0 ? n / length : glm::vec3(0, 1, 0));
    }
  }
  std::shared_ptr<const scene::Primitive> at(double) override { return primitive_; }

 private:
  std::shared_ptr<scene::Primitive> primitive_ = std::make_shared<scene::Primitive>();
};

void addTriangles(scene::Scene& scene, const std::vector<glm::vec3>& corners) {
  scene::Material material;
  material.baseColour = glm::vec4(0.5f, 0.5f, 0.5f, 1);
  material.metallic = 0;
  material.doubleSided = true;
  scene.dynamic.push_back(
      {"stress", std::make_shared<FixedGeometry>(corners), static_cast<int>(scene.materials.size())});
  scene.materials.push_back(material);
}

/// Brings what scatters below a surface to a base colour or an index that has changed.
void followSurface(scene::Material& material, bool colourChanged) {
  if (!material.subsurface) return;
  scene::Subsurface& below = *material.subsurface;
  if (colourChanged || below.albedoFromBaseColour)
    below.absorption = scene::subsurfaceAbsorption(glm::vec3(material.baseColour), material.ior);
  else
    material.baseColour =
        glm::vec4(scene::subsurfaceAlbedo(below.absorption, material.ior), material.baseColour.a);
}

/// Positions and sizes by `factor`, intensities by its square (directional lights keep their irradiance), so
/// that the picture stays the same.
void scale(scene::Scene& scene, float factor) {
  scene.origin *= factor;
  for (scene::Node& node : scene.nodes) {
    node.limnArea *= factor;
    if (node.parent == scene::kNone) node.parent = -2;
  }
  scene::Node root;
  root.transform.scale = glm::vec3(factor);
  scene.nodes.insert(scene.nodes.begin(), root);  // parents come before children
  for (std::size_t i = 1; i < scene.nodes.size(); ++i)
    scene.nodes[i].parent = scene.nodes[i].parent == -2 ? 0 : scene.nodes[i].parent + 1;
  for (scene::Skin& skin : scene.skins)
    for (int& joint : skin.joints) ++joint;
  for (scene::Animation& animation : scene.animations)
    for (scene::AnimationChannel& channel : animation.channels) ++channel.node;
  for (scene::LightSource& light : scene.lights) {
    if (light.type != glsl::light_directional) light.intensity *= factor * factor;
    light.range *= factor;
  }
  for (scene::CameraLens& camera : scene.cameras) camera.near *= factor;
  for (scene::Material& material : scene.materials) {
    // Its thickness is in the space of its mesh, which the root scales.
    material.attenuationDistance *= factor;
    if (material.subsurface) material.subsurface->extinction /= factor;
  }
  scene.medium.sigmaA /= factor;
  scene.medium.sigmaS /= factor;
  if (scene.medium.grid) {
    scene::DensityGrid grid = *scene.medium.grid;
    for (int column = 0; column < 3; ++column) grid.worldToBox[column] /= factor;
    scene::setGrid(scene.medium, std::move(grid));
  }
  if (scene::Smoke* smoke = scene.medium.smoke ? &*scene.medium.smoke : nullptr)
    for (float* length : {&smoke->low.x, &smoke->low.y, &smoke->low.z, &smoke->high.x, &smoke->high.y,
                          &smoke->high.z, &smoke->whirl, &smoke->rise})
      *length *= factor;
}

/// Position and direction of the first light.
struct LightRay {
  glm::vec3 from{0, 1, 0}, direction{0, -1, 0};
};

LightRay firstLight(const scene::Scene& scene, const scene::Pose& pose) {
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    if (scene.nodes[i].light == scene::kNone) continue;
    const glm::mat4& m = pose.nodeToWorld[i];
    return {glm::vec3(m[3]), -glm::normalize(glm::vec3(m[2]))};
  }
  return {};
}

/// A square of side 2 half about `centre`, perpendicular to `normal`.
std::vector<glm::vec3> square(glm::vec3 centre, glm::vec3 normal, float half) {
  const glm::vec3 u =
      glm::normalize(glm::cross(normal, std::abs(normal.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0)));
  const glm::vec3 v = glm::cross(normal, u);
  const auto at = [&](float a, float b) { return centre + half * (a * u + b * v); };
  return {at(-1, -1), at(1, -1), at(1, 1), at(-1, -1), at(1, 1), at(-1, 1)};
}

void removeLights(scene::Scene& scene) {
  for (scene::Node& node : scene.nodes) node.light = scene::kNone;
  for (scene::Material& material : scene.materials) material.emission = glm::vec3(0);
}

void moveLightToTheFloor(scene::Scene& scene, const scene::Pose& pose) {
  const auto node =
      std::ranges::find_if(scene.nodes, [](const scene::Node& n) { return n.light != scene::kNone; });
  if (node == scene.nodes.end()) return;
  glm::vec3 from = firstLight(scene, pose).from, to = pose.bounds.centre();
  from.y = to.y = pose.bounds.low.y;
  if (glm::length(to - from) < 1e-3f * pose.bounds.radius()) from.x += pose.bounds.radius();
  node->parent = scene::kNone;
  node->matrix.reset();
  node->base = scene.origin;
  node->transform = {from, glm::quatLookAt(glm::normalize(to - from), glm::vec3(0, 1, 0)), glm::vec3(1)};
}

}  // namespace

scene::Scene stressed(scene::Scene scene, StressChange change, double amount) {
  const auto value = static_cast<float>(amount);
  const scene::Pose pose = scene::evaluate(scene, 0);
  const float radius = pose.bounds.radius();
  const glm::vec3 centre = pose.bounds.centre();
  switch (change) {
    case StressChange::none:
    case StressChange::imageWidth:
    case StressChange::cameraInside:
    case StressChange::cameraNear:
      break;
    case StressChange::refraction:
      for (scene::Material& material : scene.materials) {
        material.ior = value;
        followSurface(material, false);
      }
      break;
    case StressChange::sceneScale:
      scale(scene, value);
      break;
    case StressChange::lightSize:
      for (scene::Node& node : scene.nodes)
        if (node.limnArea != glm::vec2(0)) node.limnArea = glm::vec2(value * radius);
      break;
    case StressChange::depthRange: {
      const LightRay ray = firstLight(scene, pose);
      // A thousandth wide as the light sees them, less than a texel: it is the range alone that is difficult.
      for (const float distance : {radius / std::sqrt(value), radius * std::sqrt(value)})
        addTriangles(scene, square(ray.from + distance * ray.direction, ray.direction, 5e-4f * distance));
      break;
    }
    case StressChange::contact:
      addTriangles(
          scene, square({centre.x, pose.bounds.low.y + value * radius, centre.z}, {0, 1, 0}, 0.3f * radius));
      break;
    case StressChange::edgeOn:
      moveLightToTheFloor(scene, pose);
      break;
    case StressChange::radiance:
      for (scene::LightSource& light : scene.lights) light.intensity *= value;
      for (scene::Material& material : scene.materials) material.emission *= value;
      scene.environment.scale *= value;
      break;
    case StressChange::albedo:
      for (scene::Material& material : scene.materials) {
        material.baseColour = glm::vec4(glm::vec3(value), material.baseColour.a);
        material.baseColourTexture = {};
        followSurface(material, true);
      }
      break;
    case StressChange::noLight:
      removeLights(scene);
      scene.environment = {};
      break;
    case StressChange::oneTriangle:
      for (scene::Node& node : scene.nodes) node.mesh = scene::kNone;
      addTriangles(scene, {centre + glm::vec3(-radius, 0, -radius), centre + glm::vec3(radius, 0, -radius),
                           centre + glm::vec3(0, 0, radius)});
      break;
    case StressChange::degenerate: {
      const glm::vec3 x(0.5f * radius, 0, 0), up(0, 0.2f * radius, 0);
      addTriangles(scene,
                   {centre + up, centre + up, centre + up,                                          // a point
                    centre + up - x, centre + up, centre + up + x,                                  // a line
                    centre + up - x, centre + up + x, centre + up + 1e-30f * glm::vec3(0, 0, 1)});  // no area
      break;
    }
    case StressChange::invalidVertices:
      addTriangles(scene, {centre, centre + glm::vec3(radius, 0, 0),
                           glm::vec3(std::numeric_limits<float>::quiet_NaN())});
      break;
  }
  return scene;
}

scene::Scene litBySkyAlone(scene::Scene scene) {
  removeLights(scene);
  scene::Environment& sky = scene.environment = {};
  sky.width = 64;
  sky.height = 32;
  for (int y = 0; y < sky.height; ++y)
    for (int x = 0; x < sky.width; ++x) {
      const bool sun = y >= 6 && y < 8 && x >= 20 && x < 22;
      const float up = 1 - static_cast<float>(y) / 31.f;
      sky.texels.push_back(sun ? glm::vec3(40) : glm::vec3(0.1f) + up * glm::vec3(0.3f, 0.4f, 0.6f));
    }
  return scene;
}

scene::Scene inFog(scene::Scene scene) {
  const float radius = scene::evaluate(scene, 0).bounds.radius();
  if (!scene.medium.present() && radius > 0) {
    scene.medium.sigmaA = glm::vec3(0.05f / radius);
    scene.medium.sigmaS = glm::vec3(0.3f / radius);
  }
  return withGlass(std::move(scene));
}

scene::Scene withGlass(scene::Scene scene) {
  const scene::Pose pose = scene::evaluate(scene, 0);
  if (std::ranges::any_of(scene.materials, &scene::Material::specularSurface)) return scene;
  const scene::DrawInstance* smallest = nullptr;
  float radius = std::numeric_limits<float>::max();
  for (const scene::DrawInstance& instance : pose.instances) {
    const float size = scene::instanceBounds(scene, pose, instance).radius();
    if (instance.node == scene::kNone || !(size < radius)) continue;
    radius = size;
    smallest = &instance;
  }
  if (!smallest) return scene;
  const auto& mesh = scene.meshes[static_cast<size_t>(smallest->mesh)];
  const int material = mesh.primitives[static_cast<size_t>(smallest->primitive)].material;
  scene::Material& glass = scene.materials[static_cast<size_t>(material)];
  glass.transmission = glass.thickness = 1;
  glass.metallic = 0;
  glass.baseColour = glm::vec4(1);
  glass.baseColourTexture = {};
  return scene;
}

scene::Scene withModels(scene::Scene scene) {
  for (scene::Material& material : scene.materials) {
    if (material.specularSurface() || material.model) continue;
    glsl::MaterialModel copper{};
    copper.kind = glsl::model_torrance_sparrow;
    copper.eta = {0.2f, 0.92f, 1.1f};
    copper.k = {3.91f, 2.45f, 2.14f};
    copper.ks = glm::vec3(1);
    copper.roughness = glm::vec2(std::max(material.roughness * material.roughness, 0.05f));
    scene::setModel(material, copper);
  }
  return scene;
}

scene::CameraPose cameraAtSmallest(const scene::Scene& scene, const scene::Pose& pose,
                                   scene::CameraPose camera, float radii) {
  scene::Bounds smallest = pose.bounds;
  for (const scene::DrawInstance& instance : pose.instances) {
    const scene::Bounds bounds = scene::instanceBounds(scene, pose, instance);
    const glm::vec3 extent = bounds.high - bounds.low;
    const bool solid = std::min({extent.x, extent.y, extent.z}) > 0;  // in a plane nothing is inside
    if (solid && bounds.radius() < smallest.radius()) smallest = bounds;
  }
  camera.worldToView[3] = glm::vec4(0, 0, 0, 1);
  camera.worldToView[3] = camera.worldToView * glm::vec4(-smallest.centre(), 1);
  camera.worldToView[3].z -= radii * smallest.radius();
  return camera;
}

}  // namespace limn::bench
