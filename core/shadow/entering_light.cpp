#include "core/shadow/entering_light.h"

#include "core/gpu_scene/gpu_medium.h"
#include "core/gpu_scene/gpu_scene.h"
#include "core/gpu_scene/light_textures.h"
#include "core/shadow/alike_lights.h"

namespace limn::shadow {

using frame::Access;

EnteringLight::EnteringLight(const TechniqueInputs& inputs, const TermRequest& request, int size)
    : lights_(request.lights.size()) {
  if (lights_ > 0) maps_ = inputs.service<ShadowMapService>().request(request.lights, {.size = size});
}

void EnteringLight::declare(frame::PassBuilder& pass, const TechniqueInputs& inputs,
                            std::map<std::string, std::string>& defines) const {
  defines["LIGHT_COUNT"] = std::to_string(lights_);
  defines["MEDIUM"] = inputs.scene.medium.present() ? "1" : "0";
  pass.read(inputs.handles.frame, Access::uniformBuffer, "FrameBlock", "which places the camera sees")
      .read(inputs.gbuffer.depth, Access::sampled, kGBufferNames.depth, "which places the camera sees")
      .read(inputs.gbuffer.instance, Access::sampled, kGBufferNames.instance, "and of which body")
      .read(inputs.entering, Access::sampled, "entering", "light that enters at them");
  if (lights_ == 0) return;
  readMaps(pass, inputs.gpuScene.device(), maps_, defines);
  pass.read(inputs.handles.lights, Access::storageLoad, "Lights", "what lights send to the others");
  const scene::LightTextureInput textures(inputs.handles);
  textures.define(defines);
  textures.declare(pass);
  const scene::MediumInput medium(inputs.handles);
  medium.define(defines);
  if (inputs.scene.medium.present()) medium.declare(pass);
}

void EnteringLight::set(gpu::Program& program, float bias) const {
  if (lights_ > 0) program.set("bias", bias);
}

}  // namespace limn::shadow
