#include "assets/generator/scene.h"

namespace limn::assets {
namespace {

template <class T>
int push(std::vector<T>& list, T value) {
  list.push_back(std::move(value));
  return static_cast<int>(list.size()) - 1;
}

}  // namespace

int Scene::addTexture(std::string textureName, Image image, bool linear) {
  return push(textures, {std::move(textureName), std::move(image), linear});
}
int Scene::addMaterial(Material material) {
  return push(materials, std::move(material));
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

Material glossy(std::string name, glm::vec3 baseColour, float roughness, float metallic) {
  return {.name = std::move(name),
          .baseColour = glm::vec4(baseColour, 1),
          .roughness = roughness,
          .metallic = metallic};
}

}  // namespace limn::assets
