// Writes profiles as sums of Gaussians (d'Eon, Luebke and Enderton 2007, section 4).
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <limits>
#include <vector>

#include "core/scene/diffusion_profile.h"

namespace limn::texture_space {

/// Holds one Gaussian over the surface, e^(-r^2 / 2 v) / (2 pi v).
struct Gaussian {
  double sigma = 0;      ///< sqrt(v), m
  glm::dvec3 weight{0};  ///< part of each channel's light that leaves
};

/// Returns what part of a Gaussian lies within a radius.
inline double gaussianShare(double sigma, double radius) {
  return -std::expm1(-0.5 * (radius / sigma) * (radius / sigma));
}

/// Returns the radius within which a part of a channel's light leaves, m.
inline double radiusOfShare(const scene::ChannelProfile& channel, double share) {
  return scene::leastDistance([&](double r) { return channel.share(r) >= share; });
}

/// Returns the weights, none below 0 and with sum 1, that bring the shares of Gaussians of these widths next
/// to a channel's, and in `error` the sum of the squared differences: least squares by going through the
/// weights in turn.
inline std::vector<double> fitWeights(const scene::ChannelProfile& channel, const std::vector<double>& sigmas,
                                      double& error) {
  constexpr int places = 48, rounds = 200;
  constexpr double whole = 10;  // how much the sum counts
  const size_t count = sigmas.size();
  const double first = radiusOfShare(channel, 0.02), last = radiusOfShare(channel, 0.995);
  std::vector<double> products(count * count, whole * whole), targets(count, whole * whole);
  double squares = whole * whole;
  std::vector<double> shares(count);
  for (int k = 0; k < places; ++k) {
    const double r = first * std::pow(last / first, k / (places - 1.0)), wanted = channel.share(r);
    for (size_t i = 0; i < count; ++i) shares[i] = gaussianShare(sigmas[i], r);
    for (size_t i = 0; i < count; ++i) {
      targets[i] += shares[i] * wanted;
      for (size_t j = 0; j < count; ++j) products[i * count + j] += shares[i] * shares[j];
    }
    squares += wanted * wanted;
  }
  std::vector<double> weights(count, 0.0);
  const auto rest = [&](size_t i) {
    double sum = targets[i];
    for (size_t j = 0; j < count; ++j) sum -= products[i * count + j] * weights[j];
    return sum;
  };
  for (int round = 0; round < rounds; ++round)
    for (size_t i = 0; i < count; ++i)
      weights[i] = std::max(weights[i] + rest(i) / products[i * count + i], 0.0);
  error = squares;
  for (size_t i = 0; i < count; ++i) error -= weights[i] * (targets[i] + rest(i));
  double sum = 0;
  for (const double w : weights) sum += w;
  for (double& w : weights) w = sum > 0 ? w / sum : 1.0 / static_cast<double>(count);
  return weights;
}

/// Returns `count` Gaussians for a profile, from narrow to wide, with widths in equal ratios that all
/// channels share: of several ranges of widths the one whose sums lie nearest to the profile. Channels that
/// reflect nothing have equal weights.
inline std::vector<Gaussian> fitGaussians(const scene::Profile& profile, int count) {
  constexpr double half = 1.1774;  // the radius with half of a Gaussian's light, over sigma
  std::vector<Gaussian> best(static_cast<size_t>(count));
  for (Gaussian& g : best) g.weight = glm::dvec3(1.0 / count);
  double least = std::numeric_limits<double>::max();
  for (const double inner : {0.03, 0.06, 0.12, 0.2, 0.35})
    for (const double outer : {0.6, 0.8, 0.9, 0.96, 0.99}) {
      double narrow = std::numeric_limits<double>::max(), wide = 0;
      for (const scene::ChannelProfile& channel : profile) {
        if (!(channel.reflectance > 0)) continue;
        narrow = std::min(narrow, radiusOfShare(channel, inner) / half);
        wide = std::max(wide, radiusOfShare(channel, outer) / half);
      }
      if (!(wide > 0)) return best;
      std::vector<double> sigmas;
      sigmas.reserve(static_cast<size_t>(count));
      for (int i = 0; i < count; ++i)
        sigmas.push_back(count > 1 ? narrow * std::pow(wide / narrow, i / (count - 1.0))
                                   : std::sqrt(narrow * wide));
      std::vector<Gaussian> fit(static_cast<size_t>(count));
      double sum = 0;
      for (size_t c = 0; c < 3; ++c) {
        double error = 0;
        std::vector<double> weights(static_cast<size_t>(count), 1.0 / count);
        if (profile[c].reflectance > 0) weights = fitWeights(profile[c], sigmas, error);
        sum += profile[c].reflectance * error;
        for (size_t i = 0; i < weights.size(); ++i) {
          fit[i].sigma = sigmas[i];
          fit[i].weight[static_cast<int>(c)] = weights[i];
        }
      }
      if (sum < least) {
        least = sum;
        best = fit;
      }
    }
  return best;
}

}  // namespace limn::texture_space
