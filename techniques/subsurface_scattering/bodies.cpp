#include "techniques/subsurface_scattering/bodies.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <utility>

#include "core/base/error.h"
#include "core/scene/diffusion_profile.h"
#include "core/scene/draw_instance.h"
#include "core/scene/subsurface.h"

namespace limn::subsurface_scattering {
namespace {

using glsl::DiffusionBody;

DiffusionBody makeBody(const scene::Scene& scene, const scene::Material& material, bool textured,
                       const Drawing& drawing) {
  const float eta = scene::subsurfaceIor(material.ior);
  const glm::vec3 extinction = material.subsurface->extinction / drawing.scale;
  const glsl::DiffusionBoundary boundary = glsl::diffusion_boundary(eta);
  const glm::vec3 absorption =
      textured
          ? scene::subsurfaceAbsorption(scene::baseAlbedo(scene, material, scene::OfTexels::largest), eta)
          : material.subsurface->absorption;
  const glm::vec3 reach = glsl::diffusion_reach(extinction, absorption, glsl::walk_reflectance(boundary));
  const float unit = std::max({reach.x, reach.y, reach.z});
  return {.extinction = extinction * unit,
          .unit = unit,
          .absorption = absorption,
          .eta = eta,
          .channels = glsl::diffusion_drawn_channels(reach),
          .uniform_share = static_cast<float>(drawing.discPoints()) / static_cast<float>(drawing.samples),
          .uniform_radius = drawing.uniformRadius,
          .textured = textured ? 1u : 0u,
          .first_point = 0,
          .entering = boundary.entering};
}

bool alike(const DiffusionBody& a, const DiffusionBody& b) {
  return a.extinction == b.extinction && a.unit == b.unit && a.absorption == b.absorption && a.eta == b.eta &&
         a.textured == b.textured;
}

/// Calls `take` with what is random about each point, for each place in the pattern its samples.
template <class Take>
void forDraws(const Drawing& drawing, Take&& take) {
  const int places = drawing.block * drawing.block, disc = drawing.discPoints();
  for (int place = 0; place < places; ++place) {
    for (int i = 0; i < drawing.samples; ++i)
      take(glsl::point_draw(static_cast<uint32_t>(i * places + place), i >= drawing.samples - disc));
  }
}

template <class Colours>
void addPoints(const DiffusionBody& body, const Colours& colours, const Drawing& drawing,
               std::vector<glsl::DrawnPoint>& points) {
  const glsl::PointSource source{body.channels, body.uniform_share, body.uniform_radius};
  forDraws(drawing, [&](const glsl::PointDraw& draw) {
    const float r = glsl::drawn_radius(colours, source, draw);
    const float density = glsl::drawn_density(glsl::diffusion_density(colours, r), source, r);
    points.push_back({.offset = r * draw.direction, .inverse_density = 1 / density, .unused = 0});
  });
}

/// Throws unless the points of those bodies that have some of their own fit a storage block.
void checkPoints(std::span<const DiffusionBody> bodies, const Drawing& drawing, int64_t most) {
  const int64_t count =
      std::ranges::count_if(bodies, [](const DiffusionBody& body) { return body.textured == 0; });
  const int64_t bytes = count * drawing.points() * int64_t{sizeof(glsl::DrawnPoint)};
  if (bytes > most)
    throw UsageError(fmt::format(
        "subsurface_scattering: the points of {} materials take {} MiB, more than the {} MiB of a "
        "storage buffer; ask for fewer samples or a smaller block",
        count, bytes >> 20, most >> 20));
}

}  // namespace

int Drawing::discPoints() const {
  return static_cast<int>(std::lround(uniformShare * static_cast<float>(samples)));
}

Bodies findBodies(const scene::Scene& scene, const scene::Pose& pose, const Drawing& drawing,
                  int64_t maxStorageBlockBytes) {
  Bodies result;
  result.ofInstances.assign(pose.instances.size(), glsl::no_body);
  std::map<std::pair<int, bool>, uint32_t> ofMaterials;  // with and without colours of their own
  for (size_t i = 0; i < pose.instances.size(); ++i) {
    const scene::DrawInstance& instance = pose.instances[i];
    const scene::Material& material = scene::materialOf(scene, instance);
    if (!material.subsurface) continue;
    const bool textured = scene::albedoVaries(material, scene::primitiveOf(scene, pose, instance));
    // Copies share a body: a textured one asks for all texels of its image.
    const auto [made, isNew] =
        ofMaterials.try_emplace({scene::materialIndexOf(scene, instance), textured}, glsl::no_body);
    if (isNew) {
      const DiffusionBody body = makeBody(scene, material, textured, drawing);
      const auto known =
          std::ranges::find_if(result.bodies, [&](const DiffusionBody& other) { return alike(other, body); });
      made->second = static_cast<uint32_t>(known - result.bodies.begin());
      if (known == result.bodies.end()) result.bodies.push_back(body);
    }
    result.ofInstances[i] = made->second;
  }
  checkPoints(result.bodies, drawing, maxStorageBlockBytes);
  bool textures = false;
  for (DiffusionBody& body : result.bodies) {
    textures = textures || body.textured != 0;
    if (body.textured != 0) continue;
    body.first_point = static_cast<uint32_t>(result.points.size());
    const glsl::DiffusionBoundary boundary = glsl::diffusion_boundary(body.eta, body.entering);
    if (drawing.normalised)
      addPoints(body, glsl::normalised_colours(body.extinction, body.absorption, boundary), drawing,
                result.points);
    else
      addPoints(body, glsl::dipole_colours(body.extinction, body.absorption, boundary), drawing,
                result.points);
  }
  if (textures) forDraws(drawing, [&](const glsl::PointDraw& draw) { result.draws.push_back(draw); });
  return result;
}

}  // namespace limn::subsurface_scattering
