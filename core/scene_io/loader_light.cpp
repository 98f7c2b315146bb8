// Lights and cameras.
#include <tiny_gltf.h>

#include "core/scene/light_texture.h"
#include "core/scene_io/private/loader.h"

namespace limn::scene {

void Loader::readLights() {
  for (std::size_t i = 0; i < model_->lights.size(); ++i) {
    const tinygltf::Light& source = model_->lights[i];
    const std::string what =
        source.name.empty() ? fmt::format("light {}", i) : fmt::format("light {} '{}'", i, source.name);
    LightSource light;
    light.name = source.name;
    if (source.type == "point") {
      light.type = glsl::light_point;
    } else if (source.type == "spot") {
      light.type = glsl::light_spot;
      light.outerCone = ranged(source.spot.outerConeAngle, 0, 0.5 * glsl::pi, what + " outerConeAngle");
      light.innerCone = ranged(source.spot.innerConeAngle, 0, light.outerCone, what + " innerConeAngle");
    } else if (source.type == "directional") {
      light.type = glsl::light_directional;
    } else {
      fail(fmt::format("{}: type '{}'; point, spot or directional is accepted", what, source.type));
    }
    if (source.color.size() == 3) {
      for (int c = 0; c < 3; ++c)
        light.colour[c] = ranged(source.color[static_cast<std::size_t>(c)], 0, 1e30, what + " color");
    }
    light.intensity = ranged(source.intensity, 0, 1e30, what + " intensity");
    for (int c = 0; c < 3; ++c)
      number(static_cast<double>(light.colour[c]) * light.intensity, what + " color * intensity");
    light.range = ranged(source.range, 0, 1e30, what + " range");
    if (source.extras.IsObject() && source.extras.Has("limn_texture"))
      light.texture = readLightTexture(source.extras.Get("limn_texture"), light.type, what + " limn_texture");
    if (const auto angle = readAngle(source.extras, light.type, what)) light.angle = *angle;
    scene_.lights.push_back(std::move(light));
  }
}

std::optional<float> Loader::readAngle(const tinygltf::Value& extras, uint32_t type,
                                       const std::string& what) {
  if (!extras.IsObject() || !extras.Has("limn_angle")) return std::nullopt;
  const tinygltf::Value& angle = extras.Get("limn_angle");
  if (!angle.IsNumber()) fail(what + " limn_angle: one number (radians) is accepted");
  if (type != glsl::light_directional) {
    warn(what + ": limn_angle has a meaning for directional lights alone and is ignored");
    return std::nullopt;
  }
  return ranged(angle.GetNumberAsDouble(), 0, glsl::pi, what + " limn_angle");
}

int Loader::readLightTexture(const tinygltf::Value& index, uint32_t type, const std::string& what) {
  constexpr std::size_t most = 64;
  if (type != glsl::light_spot) {
    warn(what + ": only spots shine through a texture; it is ignored");
    return kNone;
  }
  const int given = index.IsInt() ? index.GetNumberAsInt() : kNone;
  if (given < 0 || static_cast<std::size_t>(given) >= model_->textures.size())
    fail(fmt::format("{}: the index of one of the {} textures is accepted", what, model_->textures.size()));
  const int image = readTextureImage(model_->textures[static_cast<std::size_t>(given)], true, what);
  if (image == kNone) return kNone;
  const auto known = lightTextureIndex_.find(image);
  if (known != lightTextureIndex_.end()) return known->second;
  if (scene_.lightTextures.size() == most) fail(fmt::format("{}: more than {} of them", what, most));
  const int texture = static_cast<int>(scene_.lightTextures.size());
  scene_.lightTextures.push_back(makeLightTexture(scene_.images[static_cast<std::size_t>(image)]));
  return lightTextureIndex_[image] = texture;
}

void Loader::readCameras() {
  for (std::size_t i = 0; i < model_->cameras.size(); ++i) {
    const tinygltf::Camera& source = model_->cameras[i];
    if (source.type != "perspective") {
      warn("orthographic cameras are ignored");
      cameraIndex_.push_back(kNone);
      continue;
    }
    const std::string what = fmt::format("camera {}", i);
    CameraLens lens;
    lens.name = source.name;
    lens.yfov = number(source.perspective.yfov, what + " yfov");
    lens.near = number(source.perspective.znear, what + " znear");
    if (!(lens.yfov > 0 && lens.yfov < glsl::pi))
      fail(fmt::format("{}: yfov {} rad; more than 0 and less than pi is accepted", what, lens.yfov));
    if (!(lens.near > 0)) fail(fmt::format("{}: znear {}; more than 0 is accepted", what, lens.near));
    cameraIndex_.push_back(static_cast<int>(scene_.cameras.size()));
    scene_.cameras.push_back(std::move(lens));
  }
}

}  // namespace limn::scene
