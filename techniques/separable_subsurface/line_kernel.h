// Makes what spreads light along rows and then along columns as a profile does over the surface.
//
// Rd(x, y) is taken for C p(x) p(y), where p(x) is the integral of Rd(x, y) / C over y (Jimenez et al. 2015,
// the pre-integrated kernel): exact for light that varies along one axis alone, such as a shadow's edge in a
// row or column, and for sums of such light.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>
#include <vector>

#include "core/scene/diffusion_profile.h"
#include "techniques/separable_subsurface/line_tap.glsl"

namespace limn::separable_subsurface {

using scene::ChannelProfile;
using scene::Profile;

/// Returns what part of the light that leaves does so within a distance of a line through where it entered,
/// the integral of p from -distance to distance: the mean of the share within a radius over all directions,
/// which are close to each other along the line and across it.
inline double lineShare(const ChannelProfile& profile, double distance) {
  constexpr int directions = 64;
  double sum = 0;
  for (int i = 0; i < directions; ++i) {
    const double u = (i + 0.5) / directions, rest = 1 - u;
    const double turn = u * u * u * (10 + u * (6 * u - 15));
    sum += 30 * u * u * rest * rest * profile.share(distance / std::sin(turn * 0.5 * std::numbers::pi));
  }
  return sum / directions;
}

/// Holds the taps of one material.
struct LineKernel {
  std::vector<glsl::LineTap> taps;  ///< at the place itself, then outwards on one side; both sides are alike
  glm::vec3 reflectance{0};
  float halfRadius = 0;  ///< within which half of the light of each channel that reflects any leaves, m
};

/// Returns distances for `count` taps on one side, 0 the first. Beyond the last leaves a part of the light
/// that is 1 / 8 of a tap's share, 1 % of all for 25 taps in all. Taps turn a shadow's edge into steps as
/// wide as their distance h and as high as C p h, whose squared error over all places, the sum of (C p)^2
/// h^3, is least where 1 / h goes with the cube root of the sum of (C p)^2 over the channels.
inline std::vector<double> tapDistances(const Profile& profile, int count) {
  const auto outside = [&](double distance) {
    double sum = 0;
    for (const ChannelProfile& channel : profile)
      if (channel.reflectance > 0) sum += channel.reflectance * (1 - lineShare(channel, distance));
    return sum;
  };
  const double all = outside(0);
  std::vector<double> result(static_cast<size_t>(count), 0.0);
  if (!(all > 0) || count < 2) return result;
  const double beyond = 0.125 / count;
  const double reach =
      scene::leastDistance([&](double distance) { return outside(distance) < beyond * all; });
  const double start = scene::leastDistance([&](double distance) { return outside(distance) < 0.999 * all; });

  constexpr int cells = 256;  // of distances in equal ratios
  std::array<double, cells + 1> distances{}, dense{};
  std::array<double, 3> before{};
  for (int i = 0; i <= cells; ++i) {
    const double distance = start * std::pow(reach / start, static_cast<double>(i) / cells);
    const double last = i > 0 ? distances[static_cast<size_t>(i - 1)] : 0.0;
    double squares = 0;
    for (size_t c = 0; c < 3; ++c) {
      const double share = lineShare(profile[c], distance);
      const double density = profile[c].reflectance * (share - before[c]) / (distance - last);
      squares += density * density;
      before[c] = share;
    }
    distances[static_cast<size_t>(i)] = distance;
    dense[static_cast<size_t>(i)] =
        (i > 0 ? dense[static_cast<size_t>(i - 1)] : 0.0) + std::cbrt(squares) * (distance - last);
  }
  for (int i = 1; i < count; ++i) {
    const double wanted = dense.back() * i / (count - 0.5);
    const auto above = std::ranges::lower_bound(dense, wanted);
    const auto k = static_cast<size_t>(above - dense.begin());
    const double low = k > 0 ? dense[k - 1] : 0.0, from = k > 0 ? distances[k - 1] : 0.0;
    result[static_cast<size_t>(i)] = from + (distances[k] - from) * (wanted - low) / (dense[k] - low);
  }
  return result;
}

/// Returns the taps of a profile: `taps` in all, of which one is in the middle, so that an even number counts
/// as the next odd one. Weights are those of light that is linear between taps; the last has all that leaves
/// beyond it, so that the sum over both sides is 1.
inline LineKernel lineKernel(const Profile& profile, int taps) {
  const int count = taps / 2 + 1;
  const std::vector<double> distances = tapDistances(profile, count);
  LineKernel kernel;
  kernel.taps.resize(distances.size());
  for (size_t i = 0; i < distances.size(); ++i) kernel.taps[i].offset = static_cast<float>(distances[i]);
  for (size_t c = 0; c < 3; ++c) {
    const auto channel = static_cast<int>(c);
    // Mean of the share on one side, from 0 to 1/2, between two taps and beyond the last.
    std::vector<double> means;
    for (size_t i = 1; i < distances.size(); ++i) {
      constexpr int places = 16;
      double sum = 0;
      for (int k = 0; k < places; ++k)
        sum +=
            lineShare(profile[c], distances[i - 1] + (distances[i] - distances[i - 1]) * (k + 0.5) / places);
      means.push_back(0.5 * sum / places);
    }
    means.push_back(0.5);
    kernel.taps[0].weight[channel] = static_cast<float>(2 * means[0]);
    for (size_t i = 1; i < distances.size(); ++i)
      kernel.taps[i].weight[channel] = static_cast<float>(std::max(means[i] - means[i - 1], 0.0));
    kernel.reflectance[channel] = static_cast<float>(profile[c].reflectance);
    if (profile[c].reflectance > 0)
      kernel.halfRadius = std::max(
          kernel.halfRadius,
          static_cast<float>(scene::leastDistance([&](double r) { return profile[c].share(r) > 0.5; })));
  }
  return kernel;
}

}  // namespace limn::separable_subsurface
