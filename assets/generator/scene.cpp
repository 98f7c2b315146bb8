#include "assets/generator/scene.h"

#include <cmath>

#include "glsl/diffusion/normalised.glsl"

namespace limn::assets {
namespace {

template <class T>
int push(std::vector<T>& list, T value) {
  list.push_back(std::move(value));
  return static_cast<int>(list.size()) - 1;
}

/// Fresnel's reflectance at normal incidence, of a dielectric (k = 0) or a conductor in air.
glm::vec3 normalReflectance(glm::vec3 eta, glm::vec3 k) {
  const glm::vec3 less = eta - 1.0f, more = eta + 1.0f;
  return (less * less + k * k) / (more * more + k * k);
}

/// The GGX width that is about as wide as the model's lobe; of (r.l)^p by p = 1 / (2 alpha^2) - 1 / 2.
float lobeWidth(const ReflectionModel& model) {
  if (model.model == "coated") return 0;
  if (model.exponent) return 1 / std::sqrt(2 * *model.exponent + 1);
  const glm::vec2 roughness = model.roughness.value_or(glm::vec2(0.3f));
  return std::sqrt(roughness.x * roughness.y);
}

/// What of diffuse light the diffuse part reflects. The coefficient of Banks has the integral 8/3.
glm::vec3 diffuseAlbedo(const ReflectionModel& model) {
  return model.kd.value_or(glm::vec3(0)) * (model.model == "banks" ? 8.0f / 3 : 1.0f);
}

}  // namespace

int Scene::addTexture(std::string textureName, Image image, bool linear) {
  return push(textures, {.name = std::move(textureName), .image = std::move(image), .linear = linear});
}
int Scene::addHeights(std::string textureName, Image image) {
  return push(textures, {.name = std::move(textureName), .image = std::move(image), .heights = true});
}
int Scene::addMaterial(Material material) {
  return push(materials, std::move(material));
}
int Scene::addMeasured(const std::string& materialName, brdf::AnisotropicTable table, glm::vec3 albedo) {
  measured.push_back({materialName + ".bsdf", std::move(table)});
  Material material = lambert(materialName, albedo);
  material.model = {.model = "measured", .file = measured.back().file};
  return addMaterial(std::move(material));
}
int Scene::addNode(Node node) {
  return push(nodes, std::move(node));
}
int Scene::addMesh(std::string meshName, std::vector<Primitive> primitives) {
  return push(meshes, {std::move(meshName), std::move(primitives)});
}

int Scene::add(std::string nodeName, Mesh mesh, int material) {
  std::vector<Primitive> primitives;
  primitives.push_back({std::move(mesh), material});
  Node node{.name = nodeName};
  node.mesh = addMesh(std::move(nodeName), std::move(primitives));
  return addNode(std::move(node));
}

void Scene::addCamera(std::string cameraName, glm::vec3 eye, glm::vec3 target, float yfovDegrees) {
  addNode({.name = std::move(cameraName),
           .translation = eye,
           .rotation = facing(target - eye),
           .camera = push(cameras, {.yfov = glm::radians(yfovDegrees)})});
}

void Scene::addLight(std::string lightName, const Light& light, glm::vec3 position, glm::vec3 target) {
  addNode({.name = std::move(lightName),
           .translation = position,
           .rotation = facing(target - position),
           .light = push(lights, light)});
}

void Scene::addSun(float elevation, glm::vec2 from, float intensity, glm::vec3 colour) {
  const glm::vec2 away = std::cos(glm::radians(elevation)) * glm::normalize(from);
  const glm::vec3 place(away.x, std::sin(glm::radians(elevation)), away.y);
  addLight("key", {.type = Light::Type::directional, .colour = colour, .intensity = intensity}, 3.0f * place,
           {0, 0, 0});
}

void Scene::addAreaLight(std::string lightName, glm::vec3 position, glm::vec3 target, glm::vec2 size,
                         float intensity, glm::vec3 colour, float coneDegrees) {
  Light light{.colour = colour, .intensity = intensity};
  if (coneDegrees > 0) {
    light.type = Light::Type::spot;
    light.outerConeAngle = glm::radians(coneDegrees);
    light.innerConeAngle = 0.5f * light.outerConeAngle;
  }
  addLight(std::move(lightName), light, position, target);
  nodes.back().area = size;
}

Material lambert(std::string name, glm::vec3 albedo) {
  return {.name = std::move(name), .baseColour = glm::vec4(albedo, 1), .roughness = 1, .specularFactor = 0};
}

Material glass(std::string name, float ior, glm::vec3 tint) {
  return {.name = std::move(name),
          .baseColour = glm::vec4(tint, 1),
          .roughness = 0,
          .transmission = 1,
          .ior = ior,
          .thickness = 1};
}

Material translucent(std::string name, glm::vec3 sigmaA, glm::vec3 sigmaSPrime, float ior, float roughness) {
  const glm::vec3 absorption = sigmaA / (sigmaA + sigmaSPrime);
  const glsl::WalkReflectance walk = glsl::walk_reflectance(glsl::diffusion_boundary(ior));
  glm::vec3 albedo;
  for (int c = 0; c < 3; ++c) albedo[c] = glsl::walk_albedo(walk, absorption[c]);
  Material material = glossy(std::move(name), albedo, roughness);
  material.ior = ior;
  material.subsurface = {.sigmaA = sigmaA, .sigmaSPrime = sigmaSPrime};
  return material;
}

Material glossy(std::string name, glm::vec3 baseColour, float roughness, float metallic) {
  return {.name = std::move(name),
          .baseColour = glm::vec4(baseColour, 1),
          .roughness = roughness,
          .metallic = metallic};
}

Material reflecting(std::string name, const ReflectionModel& model) {
  const glm::vec3 reflectance = model.eta ? normalReflectance(*model.eta, model.k.value_or(glm::vec3(0)))
                                          : model.ks.value_or(glm::vec3(0.5f));
  const glm::vec3 diffuse = diffuseAlbedo(model);
  const bool metal = diffuse == glm::vec3(0);
  Material material = glossy(std::move(name), metal ? reflectance : diffuse, std::sqrt(lobeWidth(model)),
                             metal ? 1.0f : 0.0f);
  if (!metal) {
    // The index of refraction whose reflectance is the mean of the channels.
    const float root = std::sqrt(glm::dot(reflectance, glm::vec3(1.0f / 3)));
    material.ior = (1 + root) / (1 - root);
  }
  material.model = model;
  return material;
}

}  // namespace limn::assets
