#include "core/radiosity/light_samples.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/scene/light_texture.h"
#include "glsl/light/light_view.glsl"
#include "glsl/light/unshadowed_light.glsl"
#include "glsl/numeric/sampling.glsl"

namespace limn::radiosity {
namespace {

/// A light is taken in pieces that span at most this many widths of the lobe, in at most a fixed number a
/// side.
constexpr float kPieceLobeWidths = 2.5f;
constexpr int kMostPieces = 8;

/// Rays to finite lights end this part of the way before them: emissive quads do not hide themselves.
constexpr float kBeforeLight = 1e-4f;

/// Sends rays from a place to points of a light.
class Shadow {
 public:
  Shadow(const glsl::Light& light, const glsl::LightView& view, const LitPlace& place,
         const Occlusion& occlusion)
      : view_(view), place_(place), occlusion_(occlusion), distant_(light.type == glsl::light_directional) {}

  bool hides(const glm::vec3& slope) const {
    const glm::vec3 origin = place_.position + place_.clearance * place_.normal;
    if (distant_) return occlusion_.blocked(origin, slope, std::numeric_limits<float>::infinity());
    const glm::vec3 target = place_.position + view_.depth * slope;
    return occlusion_.blocked(origin, target - origin, 1 - kBeforeLight);
  }
  /// Returns what the light's area around that point counts for.
  float weight(const glm::vec3& slope) const {
    const float distance2 = glm::dot(slope, slope);
    const float up = std::max(glm::dot(place_.normal, slope), 0.f) / std::sqrt(distance2);
    if (view_.cone) return up;
    return up * std::abs(glm::dot(view_.axis, slope)) / (distance2 * std::sqrt(distance2));
  }
  bool distant() const { return distant_; }

 private:
  const glsl::LightView& view_;
  const LitPlace& place_;
  const Occlusion& occlusion_;
  bool distant_;
};

/// Returns what the medium leaves of a light at a place: from the light's centre, as T_l of pictures.
glm::vec3 lightTransmittance(const glsl::Light& light, const LitPlace& place, const Occlusion& occlusion) {
  if (light.type == glsl::light_directional)
    return occlusion.transmittance(place.position, -light.direction, std::numeric_limits<float>::max());
  const glm::vec3 way = light.position - place.position;
  const float distance = glm::length(way);
  return distance > 0 ? occlusion.transmittance(place.position, way / distance, distance) : glm::vec3(1);
}

}  // namespace

void addLight(const glsl::Light& light, const LitPlace& place, const Occlusion& occlusion, int rays,
              LightAtPlace& sum) {
  if (glsl::light_is_instance(light, place.instance)) return;
  const glsl::LightView view = glsl::light_view(light, place.position, place.normal, -1);
  if (view.masked) return;
  glsl::SurfaceBrdf white{};
  white.diffuse = glm::vec3(1);
  white.alpha = 1;
  glm::vec3 irradiance = glsl::pi * glsl::unshadowed_light(light, white, place.position, place.normal,
                                                           place.normal, place.normal);
  if (irradiance == glm::vec3(0)) return;
  irradiance *= lightTransmittance(light, place, occlusion);
  const Shadow shadow(light, view, place, occlusion);
  const auto addAsOne = [&](const glm::vec3& slope, float spread) {
    if (shadow.hides(slope)) return;
    const glm::vec3 direction = glm::normalize(slope);
    sum.irradiance += irradiance;
    sum.incident.push_back(
        {direction, spread, irradiance / std::max(glm::dot(direction, place.normal), 1e-6f)});
  };
  if (!view.extended) return addAsOne(view.centre, 0);
  const glm::vec3 towards = glm::normalize(view.centre);
  const float across = std::sqrt(glm::length(view.side_u) * glm::length(view.side_v)) *
                       (view.cone ? glsl::light_view_cone_scale(view, 1) : 1);
  const float spread = std::min(across / glm::length(view.centre), glsl::incident_max_spread);
  const float width = kPieceLobeWidths * place.alpha * std::max(glm::dot(towards, place.normal), 0.1f);
  const int side = std::clamp(static_cast<int>(std::ceil(spread / width)), 1, kMostPieces);
  const int each = std::max((rays + side * side - 1) / (side * side), 1);
  const glm::vec3 turn = glsl::pixel_noise(place.seed, 0, 0);
  float whole = 0, seen = 0;
  const size_t first = sum.incident.size();
  for (int piece = 0; piece < side * side; ++piece) {
    glm::vec3 direction(0);
    float here = 0;
    for (int i = 0; i < each; ++i) {
      const glm::vec2 in = glm::fract(glsl::r2_sequence(static_cast<uint32_t>(i)) + glm::vec2(turn));
      const glm::vec2 u = (glm::vec2(float(piece % side), float(piece / side)) + in) / float(side);
      glm::vec3 slope;
      if (!glsl::light_view_sample(view, u, slope)) continue;
      const float weight = shadow.weight(slope);
      whole += weight;
      if (!(weight > 0) || shadow.hides(slope)) continue;
      here += weight;
      direction += weight * glm::normalize(slope);
    }
    const float length = glm::length(direction);
    if (!(length > 0)) continue;
    direction /= length;
    seen += here;
    const float cosine = glm::dot(direction, place.normal);
    if (cosine > 0)
      sum.incident.push_back({direction, spread / float(side), here * irradiance / std::max(cosine, 1e-3f)});
  }
  // With few rays none may have gone to a point of the light above the tangent plane.
  if (!(whole > 0)) return addAsOne(glsl::light_view_single_point(view), spread);
  for (size_t i = first; i < sum.incident.size(); ++i) sum.incident[i].irradiance /= whole;
  sum.irradiance += irradiance * (seen / whole);
}

void lightLeaves(const SceneElements& elements, std::span<const glsl::Light> lights,
                 const Occlusion& occlusion, int rays, SampleSolver& solver) {
  const ElementSpace& space = elements.space();
  tbb::parallel_for(size_t{0}, elements.leaves().size(), [&](size_t i) {
    const Leaf& leaf = elements.leaves()[i];
    if (!(leaf.used > 0)) return;
    const auto slot = static_cast<uint32_t>(i);
    const LitPlace place{.position = leaf.position,
                         .normal = leaf.normal,
                         .alpha = solver.glossy(slot) ? solver.brdf(slot).alpha : 1,
                         .clearance = space.radius() * solver.clearance(slot),
                         .seed = slot,
                         .instance = elements.forest().groups()[i / 4].object};
    LightAtPlace sum;
    for (glsl::Light light : lights) {
      light.emission *= scene::lightTextureAt(elements.scene(), light, leaf.position);
      addLight(light, place, occlusion, rays, sum);
    }
    for (glsl::IncidentLight& incident : sum.incident)
      incident.direction = space.direction(incident.direction);
    solver.light(slot, sum.irradiance, sum.incident);
  });
}

}  // namespace limn::radiosity
