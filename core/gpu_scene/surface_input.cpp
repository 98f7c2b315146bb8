#include "core/gpu_scene/surface_input.h"

#include <fmt/format.h>

namespace limn::scene {

using frame::Access;

void SurfaceInput::define(std::map<std::string, std::string>& defines) const {
  defines["MATERIAL_MODELS"] = fmt::format("{}", handles_.modelKinds);
  defines["SURFACE_TANGENTS"] = gbuffer_.tangent ? "1" : "0";
  defines["SURFACE_PLACES"] = gbuffer_.places ? "1" : "0";
  if (!handles_.surface) return;
  defines["SURFACE_ANSWER"] = handles_.surface->file;
  for (const auto& [name, value] : handles_.surface->defines) defines[name] = value;
}

void SurfaceInput::declare(frame::PassBuilder& pass) const {
  readSurfaces(pass, gbuffer_);
  if (!handles_.models) return;
  pass.read(gbuffer_.instance, Access::sampled, kGBufferNames.instance, "materials of surfaces")
      .read(handles_.instances, Access::storageLoad, "Instances", "materials of surfaces")
      .read(handles_.models, Access::storageLoad, "MaterialModels", "how materials reflect light");
  if (handles_.measured)
    pass.read(handles_.measured, Access::storageLoad, "MeasuredValues", "measured reflectance");
  if (gbuffer_.tangent)
    pass.read(gbuffer_.tangent, Access::sampled, kGBufferNames.tangent, "along which anisotropy lies");
  if (!handles_.surface) return;
  for (const SurfaceAnswer::Texture& t : handles_.surface->textures)
    pass.read(t.texture, Access::sampled, t.name, t.why);
}

}  // namespace limn::scene
