#include "core/reference/private/content_hash.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <memory>
#include <type_traits>
#include <vector>

#include "core/reference/private/ray_scene.h"
#include "core/relief/height_field.h"

namespace limn::reference {
namespace {

/// Counts the changes of this code that change pictures: old cached results are then not found any more.
constexpr uint32_t kCodeVersion = 3;

class Hasher {
 public:
  Hasher() : state_(XXH3_createState(), XXH3_freeState) { XXH3_128bits_reset(state_.get()); }

  /// Values without padding bytes.
  template <class T>
  void add(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    XXH3_128bits_update(state_.get(), &value, sizeof(T));
  }
  template <class T>
  void add(const std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    add(values.size());
    if (!values.empty()) XXH3_128bits_update(state_.get(), values.data(), values.size() * sizeof(T));
  }
  template <class... T>
  void addAll(const T&... values) {
    (add(values), ...);
  }
  std::string digest() const {
    const XXH128_hash_t hash = XXH3_128bits_digest(state_.get());
    return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
  }

 private:
  std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> state_;
};

void addTexture(Hasher& h, const scene::TextureRef& texture) {
  h.addAll(texture.image, texture.wrapS, texture.wrapT);
}

void addMaterial(Hasher& h, const scene::Material& m) {
  h.addAll(m.baseColour, m.metallic, m.roughness, m.normalScale, m.emission, m.alphaCutoff, m.doubleSided,
           m.ior);
  h.addAll(m.specularFactor, m.specularColour, m.transmission, m.thickness, m.attenuationDistance,
           m.attenuationColour);
  for (const auto* texture :
       {&m.baseColourTexture, &m.metalRoughTexture, &m.normalTexture, &m.emissiveTexture})
    addTexture(h, *texture);
  constexpr uint32_t heightFollows = 0x4e16;  // tells it from what else may follow
  if (m.height != scene::kNone) h.addAll(heightFollows, m.height);
  constexpr uint32_t subsurfaceFollows = 0x5b56;
  if (m.subsurface)
    h.addAll(subsurfaceFollows, m.subsurface->extinction, m.subsurface->absorption,
             m.subsurface->albedoFromBaseColour);
  constexpr uint32_t unlitFollows = 0x0117;
  if (m.unlit) h.add(unlitFollows);
  if (m.model) h.add(*m.model);
  constexpr uint32_t coatsMirrorEnvironment = 0xc0a7;  // earlier results show their bases alone
  if (m.model && m.model->kind == glsl::model_coated) h.add(coatsMirrorEnvironment);
}

void addPrimitive(Hasher& h, const scene::Primitive& p) {
  h.addAll(p.positions, p.normals, p.tangents, p.uvs, p.colours, p.joints, p.weights, p.indices, p.material);
  for (const auto& target : p.morphTargets) h.addAll(target.positions, target.normals, target.tangents);
}

void addHeights(Hasher& h, const relief::HeightField& field) {
  h.addAll(field.size(), field.spacing(), field.wrap());
  std::vector<double> heights;
  heights.reserve(field.texels());
  for (int y = 0; y < field.size().y; ++y)
    for (int x = 0; x < field.size().x; ++x) heights.push_back(field.texel({x, y}));
  h.add(heights);
}

void addScene(Hasher& h, const scene::Scene& scene) {
  h.add(scene.images.size());
  for (const auto& image : scene.images) {
    h.addAll(image.srgb, image.levels.size());
    for (const auto& level : image.levels) h.addAll(level.width, level.height, level.rgba);
  }
  h.add(scene.materials.size());
  for (const auto& material : scene.materials) addMaterial(h, material);
  for (const auto& field : scene.heights) addHeights(h, field);
  if (!scene.measured.empty()) h.add(scene.measured);
  h.add(scene.meshes.size());
  for (const auto& mesh : scene.meshes) {
    h.add(mesh.primitives.size());
    for (const auto& primitive : mesh.primitives) addPrimitive(h, primitive);
  }
  for (const auto& dynamic : scene.dynamic) h.add(dynamic.material);
  for (const auto& texture : scene.lightTextures) h.add(texture.texels);
  if (scene.medium.present()) h.addAll(scene.medium.sigmaA, scene.medium.sigmaS, scene.medium.g);
  const scene::Environment& e = scene.environment;
  h.addAll(e.width, e.height, e.texels, e.rotation, e.scale);
}

void addPose(Hasher& h, const scene::Pose& pose, int lights) {
  h.add(pose.instances.size());
  constexpr uint32_t mirroredSkin = 0x5c14;    // where there is one, for other results are known without it
  constexpr uint32_t withoutInverse = 0xf1a7;  // earlier results show such copies elsewhere
  for (const auto& i : pose.instances) {
    h.addAll(i.node == scene::kNone, i.mesh, i.primitive, i.objectToWorld, i.deformed);
    if (i.mirroredSkin) h.add(mirroredSkin);
    if (i.node != scene::kNone && i.deformed == scene::kNone && !takesRays(i.objectToWorld))
      h.add(withoutInverse);
  }
  h.add(pose.deformed.size());
  for (const auto& d : pose.deformed) h.addAll(d.mesh, d.primitive, d.joints, d.morphWeights);
  for (const auto& d : pose.dynamic) addPrimitive(h, *d.primitive);
  h.add(std::vector<glsl::Light>(pose.lights.begin(), pose.lights.begin() + lights));
}

/// Where the medium is not homogeneous.
void addDensity(Hasher& h, const scene::Medium& medium, double time) {
  if (!medium.inhomogeneous()) return;
  if (medium.grid) h.addAll(medium.grid->size, medium.grid->values, medium.grid->worldToBox);
  if (!medium.smoke) return;
  const scene::Smoke& s = *medium.smoke;
  h.addAll(s.low, s.high, s.whirl, s.rise, s.seed, s.resolution, time);
}

/// Adds what tells pictures from earlier results that were wrong, where the request has what they had wrong.
void addMends(Hasher& h, const Request& r) {
  constexpr uint32_t causticVersion = 4;
  const bool caustics = r.term == Term::final || r.term == Term::caustic || r.term == Term::media;
  const bool chains = r.term == Term::specular && r.interfaces == kAllInterfaces;
  const bool specular = std::ranges::any_of(r.scene.materials, &scene::Material::specularSurface);
  if (specular && (caustics || chains)) h.add(causticVersion);
  constexpr uint32_t squaredIndices = 0x1d62;  // earlier results show what is in bodies n^2 too bright
  const bool seen = r.interfaces != 0 && (r.term == Term::final || r.term == Term::specular);
  const bool bodies = std::ranges::any_of(
      r.scene.materials, [](const scene::Material& m) { return m.transmission > 0 && m.thickness > 0; });
  if (seen && bodies) h.add(squaredIndices);
  constexpr uint32_t hiddenAsSeen = 0x5eeb;  // earlier results lack caustics behind back faces
  if (specular && (r.term == Term::final || r.term == Term::caustic)) h.add(hiddenAsSeen);
  constexpr uint32_t thicknessOfMeshes = 0x7c1c;  // earlier results have thickness in metres of the world
  const bool absorbing = std::ranges::any_of(r.scene.materials, [](const scene::Material& m) {
    return m.transmission > 0 && m.thickness > 0 && m.attenuationDistance > 0;
  });
  if (r.interfaces == 0 && r.term == Term::final && absorbing) h.add(thicknessOfMeshes);
  constexpr uint32_t airlightVersion = 0xa162;
  const bool air = r.term == Term::final || r.term == Term::media;
  if (air && r.scene.medium.sigmaS != glm::vec3(0) && r.scene.environment) h.add(airlightVersion);
  constexpr uint32_t discsInFogVersion = 0xd15c;
  const bool discs = std::ranges::any_of(r.pose.lights, [](const glsl::Light& light) {
    return glsl::light_kind(light) == glsl::light_kind_disc && light.angular_diameter > 0;
  });
  if (air && r.scene.medium.sigmaS != glm::vec3(0) && discs) h.add(discsInFogVersion);
  constexpr uint32_t indicesOfMetals = 0x3e03;  // earlier results have indices of at most 3
  if (std::ranges::any_of(r.scene.materials, [](const scene::Material& m) { return m.ior > 3; }))
    h.add(indicesOfMetals);
  constexpr uint32_t footprintsOfPixels = 0xaa2d;  // earlier results have textures as fine as samples lie
  if (r.aa > 1 && std::ranges::any_of(r.scene.materials, &scene::Material::textured))
    h.add(footprintsOfPixels);
  constexpr uint32_t narrowSpots = 0x5b07;  // earlier results lack some of their light
  const bool narrow = std::ranges::any_of(r.pose.lights, [](const glsl::Light& light) {
    return (light.flags & glsl::light_flag_cone) != 0 && light.cos_inner - light.cos_outer < 1e-4f;
  });
  if (narrow) h.add(narrowSpots);
  constexpr uint32_t mountedLamps = 0x1a3d;  // earlier results are dark where a lamp lies in a surface
  const bool lit = r.term != Term::caustic && r.term != Term::media;
  const bool lamps = std::ranges::any_of(r.pose.lights, [](const glsl::Light& light) {
    return light.type == glsl::light_point || light.type == glsl::light_spot;
  });
  if (lit && lamps && !r.unshadowed) h.add(mountedLamps);
}

void addWork(Hasher& h, const Request& r) {
  h.add(kCodeVersion);
  addScene(h, r.scene);
  addDensity(h, r.scene.medium, r.pose.time);
  // Lights that stand for the environment do not change pictures of all light.
  addPose(h, r.pose, r.light == kAllLights ? ownLights(r.pose) : static_cast<int>(r.pose.lights.size()));
  h.addAll(r.camera.worldToView, r.camera.yfov, r.camera.near);
  h.addAll(r.width, r.height, termInfo(r.term).hashed, r.light, r.seed, r.aa);
  if (r.bounces > 0) h.add(r.bounces);
  constexpr uint32_t interfacesFollow = 0x5eec;  // tells them from bounces
  if (r.interfaces != 0) h.addAll(interfacesFollow, r.interfaces);
  constexpr uint32_t unshadowedFollows = 0x0b5c;
  if (r.unshadowed) h.add(unshadowedFollows);
  constexpr uint32_t reliefPathsFollow = 0xb0b5;
  if (r.reliefPaths != ReliefPaths::both) h.addAll(reliefPathsFollow, r.reliefPaths);
  constexpr uint32_t subsurfaceModelFollows = 0x5b5f;
  if (r.subsurface != SubsurfaceModel::bssrdf) h.addAll(subsurfaceModelFollows, r.subsurface);
  addMends(h, r);
}

}  // namespace

std::string workHash(const Request& request) {
  Hasher hasher;
  addWork(hasher, request);
  return hasher.digest();
}

std::string contentHash(const Request& request) {
  Hasher hasher;
  addWork(hasher, request);
  hasher.addAll(request.spp, request.noise);
  constexpr uint32_t noiseVersion =
      2;  // earlier results have that of single samples of aa, or found no light
  if (request.aa > 1 || (request.noise > 0 && request.term == Term::caustic)) hasher.add(noiseVersion);
  return hasher.digest();
}

}  // namespace limn::reference
