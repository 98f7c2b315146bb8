// Declares a posed scene as rays see it: Embree's hierarchies, one draw per entry of Pose::instances.
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "core/reference/private/ray_medium.h"
#include "core/relief/slopes.h"
#include "core/scene/environment_light.h"
#include "core/scene/scene.h"
#include "glsl/scene/blocks.glsl"

namespace limn::reference {

/// Holds the triangles of one draw instance. Vertex positions are in the space that `toWorld` maps to world
/// space (identity where the hierarchy holds world-space positions); normals and tangents are in the space of
/// the other two matrices.
struct Draw {
  const scene::Primitive* primitive = nullptr;
  const scene::Material* material = nullptr;
  const glm::vec3* positions = nullptr;
  const glm::vec3* normals = nullptr;
  const glm::vec4* tangents = nullptr;  ///< null: none
  /// The material's height map; null without one, without the coordinates and tangents that it needs, and
  /// where it is level: that is no bumps.
  const relief::HeightField* heights = nullptr;
  glm::mat4 toWorld{1};
  glm::mat3 normalToWorld{1};
  glm::mat3 tangentToWorld{1};
  /// Holds -1 where toWorld, or else the transform of a skinned primitive's node, mirrors: front faces and
  /// bitangents flip.
  float orientation = 1;
  /// Distance in metres, along the normal, that takes a point of the surface clear of it despite rounding:
  /// 2^-20 of the largest coordinate met on the way from vertices to world space.
  float rayOffset = 0;
};

struct Hit {
  uint32_t draw = 0, triangle = 0;
  float u = 0, v = 0;  ///< barycentric coordinates of the triangle's second and third vertex
  float depth = 0;     ///< along the camera's axis, metres; of nearest(): in lengths of its direction
};

/// Returns whether rays can be taken into the space of an instance. They cannot where the matrix is flat or
/// nearly so, and where its factors are so far from 1 that floats hold no inverse or no ray there.
inline bool takesRays(const glm::mat4& objectToWorld) {
  constexpr double least = 1e-5;  // floats round by 6e-8, which the inverse of such a matrix makes 0.6 %
  constexpr double most = 1e8;
  const glm::dmat3 matrix{glm::dmat4(objectToWorld)};
  const double sides = glm::length(matrix[0]) * glm::length(matrix[1]) * glm::length(matrix[2]);
  if (!(std::abs(glm::determinant(matrix)) > least * sides)) return false;
  const glm::dmat3 inverse = glm::inverse(matrix);
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row)
      if (!(std::abs(matrix[column][row]) <= most && std::abs(inverse[column][row]) <= most)) return false;
  return true;
}

/// Returns the barycentric coordinates (u, v) at which the line through `origin` along `direction` meets the
/// plane of the triangle p0, p1, p2; not finite where they are parallel.
glm::vec2 barycentricOnPlane(const glm::vec3& p0, const glm::vec3& p1, const glm::vec3& p2,
                             const glm::vec3& origin, const glm::vec3& direction);

/// Returns the world direction of a pixel's view ray; its component along the camera's axis is 1.
inline glm::vec3 viewRay(const glsl::FrameBlock& frame, float x, float y) {
  return glm::vec3(frame.view_ray_origin) + x * glm::vec3(frame.view_ray_dx) +
         y * glm::vec3(frame.view_ray_dy);
}

/// Names a sample of a picture: pixel (x, y), from the lower left, of a view with aa x aa of them in each of
/// the picture's pixels.
struct ViewPixel {
  int x = 0, y = 0, aa = 1;
};

/// Holds the change of the texture coordinates over one pixel of the picture, as frames of a sample each see
/// it, which pictures are averaged of: differences on the triangle's plane between the samples at that place
/// in the pixels of a 2x2 quad.
struct TextureFootprint {
  glm::vec2 dx{0}, dy{0};
};
TextureFootprint textureFootprint(const Draw& draw, uint32_t triangle, const glsl::FrameBlock& frame,
                                  const ViewPixel& pixel);

/// Returns the level of detail of `texture` for that footprint.
float levelOfDetail(const scene::Scene& scene, const scene::TextureRef& texture,
                    const TextureFootprint& footprint);
/// Returns that of a texture of `size` texels.
float levelOfDetail(const glm::vec2& size, const TextureFootprint& footprint);

class RayScene {
 public:
  /// Builds the hierarchies with the calling thread's TBB arena. With `unshadowed` nothing keeps light from
  /// arriving. Throws Error if Embree fails (out of memory).
  RayScene(const scene::Scene& scene, const scene::Pose& pose, bool unshadowed);
  ~RayScene();
  RayScene(const RayScene&) = delete;
  RayScene& operator=(const RayScene&) = delete;

  const scene::Scene& scene() const { return scene_; }
  const std::vector<Draw>& draws() const { return draws_; }
  const RayMedium& medium() const { return medium_; }
  /// Returns the scene's environment. Its tables are made when it is asked for first, by whichever thread.
  const scene::EnvironmentLight& environment() const;
  /// Returns the slopes of a map of Scene::heights, as textures.
  const std::vector<relief::SlopeLevel>& slopes(int height) const {
    return slopes_[static_cast<size_t>(height)];
  }

  /// Finds the nearest surface that the camera sees at the centre of the pixel, beyond `near`, and returns
  /// whether there is one: cut-out texels and back faces of single-sided surfaces are passed through.
  bool see(const glsl::FrameBlock& frame, float near, const ViewPixel& pixel, Hit& hit) const;

  /// Returns whether what see() finds lies between the camera's near plane, at `near`, and `origin`, which
  /// the pixel shows, lies behind that plane and is clear of surfaces.
  bool hidden(const glsl::FrameBlock& frame, float near, const ViewPixel& pixel,
              const glm::vec3& origin) const;

  /// Finds the nearest surface on origin + t * direction, t > 0, seen from either side, and returns whether
  /// there is one; cut-out texels (of the full-size level) are passed through.
  bool nearest(const glm::vec3& origin, const glm::vec3& direction, Hit& hit) const;

  /// Finds the nearest surface of one draw of a translucent material on origin + t * direction, `from` < t <
  /// `to`, seen from either side, and returns whether there is one.
  bool nearestOfBody(uint32_t draw, const glm::vec3& origin, const glm::vec3& direction, float from, float to,
                     Hit& hit) const;

  /// Returns the bounds of a draw of a translucent material, world.
  scene::Bounds bodyBounds(uint32_t draw) const;

  /// Returns whether anything but cut-out texels lies on origin + t * direction, 0 < t < end.
  bool occluded(const glm::vec3& origin, const glm::vec3& direction, float end) const;

  /// Returns whether light is kept from arriving along that line: never without shadows, else if anything
  /// occludes it.
  bool shadowed(const glm::vec3& origin, const glm::vec3& direction, float end) const {
    return !unshadowed_ && occluded(origin, direction, end);
  }

 private:
  struct Hierarchy;
  const scene::Scene& scene_;
  bool unshadowed_;
  std::vector<Draw> draws_;
  RayMedium medium_;
  std::vector<std::vector<relief::SlopeLevel>> slopes_;
  mutable std::once_flag environmentAsked_;
  mutable std::optional<scene::EnvironmentLight> environment_;
  std::unique_ptr<Hierarchy> hierarchy_;
};

}  // namespace limn::reference
