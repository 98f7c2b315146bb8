// Declares what a ray meets, in a pixel or further on: the same surface values as the G-buffer, unquantised.
#pragma once

#include <optional>

#include "core/reference/private/ray_scene.h"
#include "core/reference/private/relief_place.h"
#include "glsl/diffusion/boundary.glsl"
#include "glsl/materials/model.glsl"
#include "glsl/numeric/geometry.glsl"
#include "glsl/surface/brdf.glsl"
#include "glsl/surface/gbuffer.glsl"

namespace limn::reference {

/// Holds the smooth boundary of a translucent surface, as a lobe of its reflection: `albedo` times what
/// passes into the body and, where it leaves, out again.
struct BoundaryLobe {
  glsl::DiffusionBoundary boundary{};
  glm::vec3 albedo{0};
  bool leaves = true;  ///< F_t(n.l) F_t(n.v) / (pi (1 - F_de)); else F_t(n.l) / pi alone

  /// Returns f of the lobe, 1/sr, from the cosines of the view and of the light, which is above 0.
  glm::vec3 f(float view, float light) const {
    const float out = leaves ? glsl::diffusion_exit(boundary, view) : glsl::inverse_pi;
    return albedo * (glsl::diffusion_entry(boundary, light) * out);
  }
};

struct Surface {
  glm::vec3 position{0};  ///< world, metres
  glm::vec3 view{0};      ///< unit, towards the camera or the surface that the ray came from
  float depth = 0;        ///< along the camera's axis, metres; 0 behind the first surface
  float rayOffset = 0;    ///< Draw::rayOffset
  uint32_t draw = 0;      ///< no_instance: a point that belongs to none
  glsl::GBufferSurface values{};
  glsl::SurfaceBrdf brdf{};  ///< metallic-roughness; of no account where there is a model
  /// Takes the place of the diffuse part of `brdf`, which then only directs samples; translucent surfaces
  /// have that of their local limit.
  std::optional<BoundaryLobe> below;
  const glsl::MaterialModel* model = nullptr;        ///< null: metallic-roughness
  const std::vector<glm::vec3>* measured = nullptr;  ///< Scene::measured
  glsl::Frame frame{};  ///< around the shading normal, along the tangent; for models
  ReliefPlace relief;   ///< among the bumps of the front; the back has none
  glm::vec4 vertexColour{1};

  bool translucent() const { return below.has_value(); }
  /// Returns a translucent surface without the light that enters it: what its boundary reflects.
  Surface reflecting() const;
  /// Returns a translucent surface that reflects what enters it, F_t / pi, and nothing else: its radiance
  /// times pi is the irradiance that enters.
  Surface entered() const;
  bool specular() const { return (values.flags & glsl::gbuffer_flag_specular) != 0; }
  /// Returns f cos for light from `direction` (unit), 1/sr; 0 below either horizon.
  glm::vec3 reflectance(const glm::vec3& direction) const;
  /// Returns the same with the shading normal's horizon alone, for light from bumps, which lie on either side
  /// of the geometric one.
  glm::vec3 reflectanceFromBump(const glm::vec3& direction) const;
  /// Returns f(towards, direction) of two unit vectors away from the surface, 1/sr, without the cosine; 0
  /// where `direction` is below the shading normal's horizon.
  glm::vec3 f(const glm::vec3& towards, const glm::vec3& direction) const;
  /// Returns the share of light from mirrorDirection() that a smooth coat reflects, which is no part of
  /// reflectance(); 0 without a coat, and where that direction is below either horizon.
  glm::vec3 mirrored() const;
  /// Returns the direction that the view is mirrored to at the shading normal.
  glm::vec3 mirrorDirection() const { return 2 * glm::dot(values.normal, view) * values.normal - view; }
  /// Returns a direction with the density pdf(), from u in [0, 1)^3.
  glm::vec3 sample(const glm::vec3& u) const;
  /// Returns the density with which sample() chooses `direction`, 1/sr.
  float pdf(const glm::vec3& direction) const;
  /// Returns where rays towards `direction` start: clear of the surface on that side of it.
  glm::vec3 rayOrigin(const glm::vec3& direction) const {
    const glm::vec3& n = values.geometric_normal;
    return position + (glm::dot(n, direction) >= 0.f ? rayOffset : -rayOffset) * n;
  }
};

/// Returns the surface at `hit`, seen in that pixel: textures at the level that its footprint asks for,
/// normals turned towards the camera where a double-sided surface shows its back.
Surface surfaceAt(const RayScene& rays, const Hit& hit, const glsl::FrameBlock& frame,
                  const ViewPixel& pixel);

/// Returns the surface at `hit`, met by a ray along `direction` (unit): textures at their full size. Returns
/// nullopt where the ray met the back of a single-sided surface, which reflects nothing.
std::optional<Surface> surfaceAlong(const RayScene& rays, const Hit& hit, const glm::vec3& direction);

/// Returns the front of the surface at `hit`: textures at their full size, seen along the normal.
Surface frontAt(const RayScene& rays, const Hit& hit);

/// Returns the surface where a ray along `direction` (unit) from `from` meets the bumps at `place`: the
/// base's point, with the field's normal and the textures at their full size as they are at the place.
Surface surfaceAtBump(const RayScene& rays, const Surface& from, const glm::dvec2& place,
                      const glm::vec3& direction);

/// Holds the point where light meets a smooth interface, from either side.
struct Interface {
  glm::vec3 position{0};
  glm::vec3 normal{0}, geometricNormal{0};  ///< unit, both turned to the side that the light comes from
  bool back = false;                        ///< that side is the surface's back
  glm::vec3 baseColour{0};
  float metallic = 0;
  float rayOffset = 0;  ///< Draw::rayOffset
  uint32_t draw = 0;
};
Interface interfaceAt(const RayScene& rays, const Hit& hit, const glm::vec3& direction);

}  // namespace limn::reference
