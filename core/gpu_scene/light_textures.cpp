#include "core/gpu_scene/light_textures.h"

namespace limn::scene {

gpu::Texture makeLightTextures(gpu::Device& device, const Scene& scene) {
  if (scene.lightTextures.empty()) return {};
  gpu::Texture textures(device, "light textures",
                        {.target = GL_TEXTURE_2D_ARRAY,
                         .format = GL_RGBA32F,
                         .width = LightTexture::side,
                         .height = LightTexture::side,
                         .layers = static_cast<int>(scene.lightTextures.size())});
  textures.setSampling(GL_LINEAR, GL_LINEAR, GL_CLAMP_TO_EDGE, GL_CLAMP_TO_EDGE);
  for (size_t i = 0; i < scene.lightTextures.size(); ++i)
    textures.upload(0, static_cast<int>(i), GL_RGB, GL_FLOAT, scene.lightTextures[i].texels.data());
  return textures;
}

void LightTextureInput::define(std::map<std::string, std::string>& defines) const {
  defines["LIGHT_TEXTURES"] = textures_ ? "1" : "0";
}

void LightTextureInput::declare(frame::PassBuilder& pass) const {
  if (textures_)
    pass.read(textures_, frame::Access::sampled, "light_textures", "textures that lights shine through");
}

}  // namespace limn::scene
