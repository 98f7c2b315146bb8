#include "core/reference/private/camera_radiance.h"

#include "glsl/caustics/specular_view.glsl"

namespace limn::reference {

glm::vec3 cameraRadiance(const Surface& surface, const Draw& draw,
                         const scene::EnvironmentLight& environment) {
  const glsl::GBufferSurface& values = surface.values;
  if (!surface.specular()) return values.emission;
  const scene::Material& material = *draw.material;
  const glsl::SpecularView seen = glsl::specular_view(
      surface.brdf, values.base_colour, values.metallic, material.transmission, values.ior,
      material.thickness * glsl::body_scale(draw.tangentToWorld), material.attenuationColour,
      material.attenuationDistance, values.normal, surface.view);
  return values.emission + seen.reflected * environment.radiance(seen.reflection) +
         seen.transmitted * environment.radiance(seen.refraction);
}

}  // namespace limn::reference
