// What the camera sees in a pixel: the same surface values as the G-buffer, unquantised.
#pragma once

#include "core/reference/ray_scene.h"
#include "glsl/brdf.glsl"
#include "glsl/gbuffer.glsl"

namespace limn::reference {

struct Surface {
  glm::vec3 position{0};  ///< world, metres
  glm::vec3 view{0};      ///< unit, towards the camera
  float depth = 0;        ///< along the camera's axis, metres
  float rayOffset = 0;    ///< Draw::rayOffset
  uint32_t draw = 0;
  glsl::GBufferSurface values{};
  glsl::SurfaceBrdf brdf{};

  bool specular() const { return (values.flags & glsl::gbuffer_flag_specular) != 0; }
  /// Where rays leave from towards `direction`: clear of the surface on that side of it.
  glm::vec3 rayOrigin(const glm::vec3& direction) const {
    const glm::vec3& n = values.geometric_normal;
    return position + (glm::dot(n, direction) >= 0.f ? rayOffset : -rayOffset) * n;
  }
};

/// The surface at `hit`, seen in pixel (x, y): textures at the level that the pixel's quad asks for, normals
/// turned towards the camera where a double-sided surface shows its back.
Surface surfaceAt(const RayScene& rays, const Hit& hit, const glsl::FrameBlock& frame, int x, int y);

}  // namespace limn::reference
