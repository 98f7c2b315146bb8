#include "core/reference/private/subsurface_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/reference/private/subsurface_walk.h"
#include "glsl/diffusion/dipole.glsl"
#include "glsl/diffusion/normalised.glsl"

namespace limn::reference {
namespace {

/// Random numbers of light below surfaces lie behind those of what the surface reflects.
constexpr uint32_t kFirstWalkPair = 1u << 28;
constexpr uint32_t kPairsOfWalk = 1u << 22;
/// Limits the places that one line meets.
constexpr uint32_t kMostPlaces = 256;
/// Mean free paths that are shorter than this many of Draw::rayOffset are too short for distances between
/// positions in single precision: light leaves where it enters.
constexpr double kLeastProbed = 8, kLeastWalked = 256;

/// The matter below a place.
struct Matter {
  glsl::DiffusionBoundary boundary{};
  glm::vec3 extinction{1}, absorption{0};
};

Matter matterBelow(const RayScene& rays, const Surface& surface) {
  const scene::Subsurface& given = *rays.draws()[surface.draw].material->subsurface;
  Matter matter{surface.below->boundary, given.extinction, given.absorption};
  if (given.albedoFromBaseColour)
    matter.absorption =
        glsl::walk_absorption(glsl::walk_reflectance(matter.boundary), surface.values.base_colour);
  return matter;
}

/// Returns whether the channel's light leaves where it enters, as far as positions can tell.
bool isLocal(const Matter& matter, int channel, float rayOffset, double least) {
  return static_cast<double>(matter.extinction[channel]) * least * static_cast<double>(rayOffset) > 1;
}

/// One channel's profile in metres, cut off where the body ends.
struct Profile {
  glsl::DiffusionDipole dipole{};
  double extinction = 1;
  float realShare = 1, virtualShare = 0;  ///< of all light: of each source, within the reach

  Profile() = default;
  Profile(const Matter& matter, int channel, double reach)
      : dipole(glsl::diffusion_dipole(matter.absorption[channel], matter.boundary)),
        extinction(static_cast<double>(matter.extinction[channel])) {
    const auto r = static_cast<float>(reach * extinction);
    realShare = dipole.real_share * glsl::diffusion_source_share(1, dipole.decay, r);
    virtualShare =
        (1 - dipole.real_share) * glsl::diffusion_source_share(dipole.virtual_height, dipole.decay, r);
  }
  /// A radius within the reach, with density().
  double radius(float xi) const {
    const float light = xi * (realShare + virtualShare);
    const bool real = light < realShare || !(virtualShare > 0);
    const float share = real ? light / dipole.real_share : (light - realShare) / (1 - dipole.real_share);
    const float height = real ? 1 : dipole.virtual_height;
    return static_cast<double>(glsl::diffusion_source_radius(height, dipole.decay, share)) / extinction;
  }
  double wholeDensity(double r) const {
    return extinction * extinction *
           static_cast<double>(glsl::diffusion_dipole_density(dipole, static_cast<float>(r * extinction)));
  }
  /// Per square metre of the disc.
  double density(double r) const { return wholeDensity(r) / static_cast<double>(realShare + virtualShare); }
  /// Rd, per square metre.
  double value(double r) const { return static_cast<double>(dipole.reflectance) * wholeDensity(r); }
};

/// The lines along which places of the body are looked for: the normal and two tangents through discs around
/// the place that light leaves at, with radii of any channel's profile.
struct Probes {
  std::array<glm::dvec3, 3> axes;
  std::array<Profile, 3> profiles;
  std::array<int, 3> channels{};
  size_t channelCount = 0;

  static constexpr std::array<double, 3> kShares{0.5, 0.25, 0.25};

  explicit Probes(const glm::vec3& normal) {
    const glsl::Frame frame = glsl::frame_around(normal);
    axes = {glm::dvec3(frame.n), glm::dvec3(frame.t), glm::dvec3(frame.b)};
  }
  void add(int channel, const Profile& profile) {
    profiles[static_cast<size_t>(channel)] = profile;
    channels[channelCount++] = channel;
  }
  const Profile& chosen(float u) const {
    const auto i = static_cast<size_t>(u * static_cast<float>(channelCount));
    return profiles[static_cast<size_t>(channels[std::min(i, channelCount - 1)])];
  }
  /// Density per area of a surface with that normal at which any of the lines meets it, `way` from the place.
  double density(const glm::dvec3& way, const glm::dvec3& normal) const {
    double sum = 0;
    for (size_t k = 0; k < axes.size(); ++k) {
      const double r = glm::length(way - glm::dot(way, axes[k]) * axes[k]);
      double mean = 0;
      for (size_t i = 0; i < channelCount; ++i)
        mean += profiles[static_cast<size_t>(channels[i])].density(r) / static_cast<double>(channelCount);
      sum += kShares[k] * std::abs(glm::dot(normal, axes[k])) * mean;
    }
    return sum;
  }
};

/// The distance from a place within which the whole box lies.
double farthest(const scene::Bounds& box, const glm::vec3& place) {
  const glm::dvec3 p(place);
  return glm::length(glm::max(glm::abs(glm::dvec3(box.low) - p), glm::abs(glm::dvec3(box.high) - p)));
}

}  // namespace

glm::dvec3 SubsurfaceLight::localLight(const Surface& surface, const Entering& entering) const {
  return glm::dvec3(surface.below->albedo) * entering(surface.entered(), 0);
}

/// All of a line's places count, each with the density of all lines together (Veach's balance heuristic).
glm::dvec3 SubsurfaceLight::probedLight(const Surface& surface, const Sampler& sampler,
                                        const Entering& entering) const {
  const Matter matter = matterBelow(rays_, surface);
  const double reach = farthest(rays_.bodyBounds(surface.draw), surface.position);
  Probes probes(surface.values.geometric_normal);
  glm::dvec3 radiosity(0), here(0);
  for (int c = 0; c < 3; ++c) {
    const Profile profile(matter, c, reach);
    if (isLocal(matter, c, surface.rayOffset, kLeastProbed))
      here[c] = static_cast<double>(profile.dipole.reflectance);
    else if (profile.dipole.reflectance > 0 && profile.realShare > 0)
      probes.add(c, profile);
  }
  if (here != glm::dvec3(0)) radiosity += here * entering(surface.entered(), 0);
  if (probes.channelCount == 0) return radiosity;

  const glm::vec2 choice = sampler.pair(kFirstWalkPair), disc = sampler.pair(kFirstWalkPair + 1);
  const size_t axis = choice.x < 0.5f ? 0 : choice.x < 0.75f ? 1 : 2;
  const glm::dvec3 &along = probes.axes[axis], &s = probes.axes[(axis + 1) % 3],
                   &t = probes.axes[(axis + 2) % 3];
  const double r = probes.chosen(choice.y).radius(disc.x), angle = 2 * M_PI * static_cast<double>(disc.y);
  const glm::dvec3 x(surface.position),
      start = x + r * (std::cos(angle) * s + std::sin(angle) * t) - 1.01 * reach * along;
  float from = 0;
  for (uint32_t i = 1; i <= kMostPlaces; ++i) {
    Hit hit;
    if (!rays_.nearestOfBody(surface.draw, glm::vec3(start), glm::vec3(along), from,
                             std::numeric_limits<float>::infinity(), hit))
      break;
    from = hit.depth + std::max(surface.rayOffset, 0x1p-20f * hit.depth);
    const Surface place = frontAt(rays_, hit);
    const glm::dvec3 way = glm::dvec3(place.position) - x;
    const double distance = glm::length(way),
                 density = probes.density(way, glm::dvec3(place.values.geometric_normal));
    if (!(density > 0)) continue;
    const Matter other = matterBelow(rays_, place);
    glm::dvec3 weight(0);
    for (size_t k = 0; k < probes.channelCount; ++k) {
      const int c = probes.channels[k];
      const double own = probes.profiles[static_cast<size_t>(c)].value(distance);
      const bool same = other.absorption[c] == matter.absorption[c];
      weight[c] = (same ? own : std::sqrt(own * Profile(other, c, reach).value(distance))) / density;
    }
    if (weight != glm::dvec3(0)) radiosity += weight * entering(place.entered(), i);
  }
  return radiosity;
}

glm::dvec3 SubsurfaceLight::walkedLight(const Surface& surface, const Sampler& sampler,
                                        const Entering& entering) const {
  const Matter matter = matterBelow(rays_, surface);
  const auto alike = [&](int a, int b) {
    return matter.extinction[a] == matter.extinction[b] && matter.absorption[a] == matter.absorption[b];
  };
  glm::dvec3 radiosity(0);
  for (int c = 0; c < 3; ++c) {
    if ((c > 0 && alike(c, 0)) || (c > 1 && alike(c, 1))) continue;
    const auto entry = static_cast<uint32_t>(c);
    const uint32_t pair = kFirstWalkPair + entry * kPairsOfWalk;
    const WalkMatter walked{.extinction = static_cast<double>(matter.extinction[c]),
                            .albedo = 1 - static_cast<double>(matter.absorption[c]),
                            .eta = static_cast<double>(matter.boundary.eta)};
    glm::dvec3 light(0);
    if (isLocal(matter, c, surface.rayOffset, kLeastWalked)) {
      const double cosine = static_cast<double>(glm::dot(surface.values.geometric_normal, surface.view));
      const double weight = walkThroughHalfSpace(cosine, walked, sampler, pair);
      if (weight > 0) light = weight * entering(surface.entered(), entry);
    } else {
      const WalkEnd end = walkThroughBody(rays_, surface, walked, sampler, pair);
      if (end.weight > 0) light = end.weight * entering(frontAt(rays_, end.hit).entered(), entry);
    }
    for (int other = c; other < 3; ++other)
      if (other == c || alike(other, c)) radiosity[other] = light[other];
  }
  return radiosity;
}

glm::dvec3 SubsurfaceLight::sample(const Surface& surface, const Sampler& sampler,
                                   const Entering& entering) const {
  const glm::dvec3 radiosity = model_ == SubsurfaceModel::local  ? localLight(surface, entering)
                               : model_ == SubsurfaceModel::walk ? walkedLight(surface, sampler, entering)
                                                                 : probedLight(surface, sampler, entering);
  const float cosine = glm::dot(surface.values.normal, surface.view);
  return radiosity * static_cast<double>(glsl::diffusion_exit(surface.below->boundary, cosine));
}

}  // namespace limn::reference
