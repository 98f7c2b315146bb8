// Translucent bodies made in memory, and what leaves them in pictures of the term subsurface.
#pragma once

#include <cmath>
#include <glm/glm.hpp>
#include <utility>
#include <vector>

#include "glsl/diffusion/normalised.glsl"
#include "tests/support/half_space_albedo.h"
#include "tests/support/reference_scene.h"

namespace limn::reference::test {

/// A material that scatters below its surface and has no highlight; `absorption` is 1 - a'.
inline int addTranslucent(World& world, const glm::vec3& extinction, const glm::vec3& absorption, float ior) {
  const glsl::WalkReflectance walk = glsl::walk_reflectance(glsl::diffusion_boundary(ior));
  glm::vec3 albedo;
  for (int c = 0; c < 3; ++c) albedo[c] = glsl::walk_albedo(walk, absorption[c]);
  const int index = world.addMaterial(albedo);
  scene::Material& material = world.scene.materials[static_cast<size_t>(index)];
  material.ior = ior;
  material.subsurface = {.extinction = extinction, .absorption = absorption};
  return index;
}

/// A box around the origin, closed, faces outwards.
inline scene::Primitive box(const glm::vec3& sides, int material) {
  scene::Primitive all;
  all.material = material;
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {-1.f, 1.f}) {
      glm::vec3 centre(0), u(0), v(0);
      centre[axis] = side * 0.5f * sides[axis];
      u[(axis + 1) % 3] = sides[(axis + 1) % 3];
      v[(axis + 2) % 3] = side * sides[(axis + 2) % 3];
      const scene::Primitive face = World::quad(centre, u, v, material);
      const auto base = static_cast<uint32_t>(all.positions.size());
      all.positions.insert(all.positions.end(), face.positions.begin(), face.positions.end());
      all.normals.insert(all.normals.end(), face.normals.begin(), face.normals.end());
      for (const uint32_t i : face.indices) all.indices.push_back(base + i);
    }
  return all;
}

/// A camera that sees the origin from far above the plane y = 0, at that cosine to its normal: all pixels see
/// `width` metres and have that cosine to within 1e-3.
inline scene::CameraPose distantCamera(float cosine, float width) {
  const float distance = 1000 * width;
  return scene::lookAt(distance * glm::vec3(0, cosine, std::sqrt(1 - cosine * cosine)), glm::vec3(0),
                       2 * std::atan(0.5f * width / distance));
}

/// Mean of a channel and the standard deviation of that mean by the samples' own spread.
struct Measured {
  double mean = 0, deviation = 0;
};

inline Measured measured(const Image& image, int channel = 0) {
  Measured m;
  double variance = 0;
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) {
      m.mean += static_cast<double>(image.at(x, y, channel));
      variance += static_cast<double>(image.at(x, y, image.channel("variance")));
    }
  const auto pixels = static_cast<double>(image.pixelCount());
  m.mean /= pixels;
  m.deviation = std::sqrt(variance) / pixels;
  return m;
}

/// The radiosity that leaves the plane y = 0 at the origin: the integral of the radiance times the cosine, by
/// Gauss's rule over the cosine of views from above.
inline Measured radiosity(World world, float width, SubsurfaceModel model, int side, int spp) {
  Measured sum;
  for (const auto& [cosine, weight] : limn::test::half_space::gauss(4)) {
    world.camera = distantCamera(static_cast<float>(cosine), width);
    Request request = world.request(side, Term::subsurface, spp);
    request.subsurface = model;
    const Measured m = measured(render(request).image);
    const double factor = 2 * M_PI * cosine * weight;
    sum.mean += factor * m.mean;
    sum.deviation = std::hypot(sum.deviation, factor * m.deviation);
  }
  return sum;
}

}  // namespace limn::reference::test
