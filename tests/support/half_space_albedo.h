// The reflectance of a half space that scatters isotropically under a smooth boundary, by another way than
// walks and diffusion.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "tests/support/closed_forms.h"

namespace limn::test {

/// Returns the share of diffuse light that enters and leaves again, 0 to 1; `albedo` is a', eta the index
/// inside. Radiance below the boundary is reflected by the half space as Chandrasekhar's function H says
/// (Radiative Transfer, 1950, equation III.53) and by the boundary as Fresnel says; the linear system of both
/// is solved at Gauss nodes of the cosine, `nodes` on each side of the critical angle.
double halfSpaceAlbedo(double albedo, double eta, int nodes = 16);

/// Holds what of the light that comes from one direction outside, and enters, leaves again anywhere; by
/// reciprocity also what leaves in that direction where the sky is even, over F_t times the sky's radiance.
struct LeavingShare {
  double cosine;  ///< outside
  double share;   ///< 0 to 1
  double weight;  ///< of the direction in the mean over diffuse light that enters
};

/// Returns those shares at the nodes of halfSpaceAlbedo, which is their mean.
std::vector<LeavingShare> halfSpaceShares(double albedo, double eta, int nodes = 16);

namespace half_space {

struct Direction {
  double cosine, weight, reflected;  ///< inside; of the integral over the cosine; Fresnel's share
};

/// Nodes and weights of Gauss and Legendre on [0, 1].
inline std::vector<std::pair<double, double>> gauss(int count) {
  std::vector<std::pair<double, double>> rule;
  for (int i = 0; i < count; ++i) {
    double x = std::cos(M_PI * (i + 0.75) / (count + 0.5)), slope = 1;
    for (int step = 0; step < 20; ++step) {
      double p = 1, before = 0;
      for (int k = 1; k <= count; ++k) {
        const double next = ((2 * k - 1) * x * p - (k - 1) * before) / k;
        before = p;
        p = next;
      }
      slope = count * (x * p - before) / (x * x - 1);
      x -= p / slope;
    }
    rule.emplace_back(0.5 * (x + 1), 1 / ((1 - x * x) * slope * slope));
  }
  return rule;
}

/// Nodes lie densely at grazing angles, where H is steep, and in those that leave, evenly in the cosine
/// outside.
inline std::vector<Direction> directions(double eta, int nodes) {
  std::vector<Direction> result;
  const double critical = std::sqrt(std::max(0., 1 - 1 / (eta * eta)));
  for (const auto& [x, w] : gauss(nodes)) {
    if (eta == 1) {
      result.push_back({x * x, 2 * x * w, 0});
      continue;
    }
    result.push_back({critical * x * x, 2 * critical * x * w, 1});
    const double inside = std::sqrt(1 - (1 - x * x) / (eta * eta));
    result.push_back({inside, w * x / (eta * eta * inside), fresnel(x, 1, eta)});
  }
  return result;
}

/// Solves matrix x = right by elimination with pivots.
inline std::vector<double> solve(std::vector<std::vector<double>> matrix, std::vector<double> right) {
  const size_t n = right.size();
  for (size_t k = 0; k < n; ++k) {
    size_t pivot = k;
    for (size_t i = k; i < n; ++i)
      if (std::abs(matrix[i][k]) > std::abs(matrix[pivot][k])) pivot = i;
    std::swap(matrix[k], matrix[pivot]);
    std::swap(right[k], right[pivot]);
    for (size_t i = k + 1; i < n; ++i) {
      const double factor = matrix[i][k] / matrix[k][k];
      for (size_t j = k; j < n; ++j) matrix[i][j] -= factor * matrix[k][j];
      right[i] -= factor * right[k];
    }
  }
  for (size_t k = n; k-- > 0;) {
    for (size_t j = k + 1; j < n; ++j) right[k] -= matrix[k][j] * right[j];
    right[k] /= matrix[k][k];
  }
  return right;
}

/// H at the nodes: 1 / H = sqrt(1 - a) + a / 2 int mu' H(mu') / (mu + mu') dmu', by Newton's steps.
inline std::vector<double> chandrasekhar(const std::vector<Direction>& d, double albedo) {
  const size_t n = d.size();
  std::vector<double> h(n, 1);
  for (int step = 0; step < 60; ++step) {
    std::vector<std::vector<double>> matrix(n, std::vector<double>(n));
    std::vector<double> rest(n);
    for (size_t i = 0; i < n; ++i) {
      rest[i] = std::sqrt(1 - albedo) - 1 / h[i];
      for (size_t j = 0; j < n; ++j) {
        const double kernel = 0.5 * albedo * d[j].cosine * d[j].weight / (d[i].cosine + d[j].cosine);
        rest[i] += kernel * h[j];
        matrix[i][j] = -kernel;
      }
      matrix[i][i] -= 1 / (h[i] * h[i]);
    }
    const std::vector<double> change = solve(matrix, rest);
    for (size_t i = 0; i < n; ++i) h[i] = std::max(h[i] + change[i], h[i] / 3);
  }
  return h;
}

}  // namespace half_space

inline std::vector<LeavingShare> halfSpaceShares(double albedo, double eta, int nodes) {
  const auto d = half_space::directions(eta, nodes);
  const auto h = half_space::chandrasekhar(d, albedo);
  const size_t n = d.size();
  std::vector<std::vector<double>> matrix(n, std::vector<double>(n));
  std::vector<double> upwards(n);  // radiance below the boundary, over that of the sky and eta^2
  double entering = 0;
  for (size_t i = 0; i < n; ++i) {
    entering += (1 - d[i].reflected) * d[i].cosine * d[i].weight;
    for (size_t j = 0; j < n; ++j) {
      const double part =
          0.5 * albedo * h[i] * h[j] * d[j].cosine * d[j].weight / (d[i].cosine + d[j].cosine);
      upwards[i] += part * (1 - d[j].reflected);
      matrix[i][j] = (i == j ? 1 : 0) - part * d[j].reflected;
    }
  }
  upwards = half_space::solve(matrix, upwards);
  std::vector<LeavingShare> shares;
  for (size_t i = 0; i < n; ++i)
    if (d[i].reflected < 1)
      shares.push_back({std::sqrt(std::max(0., 1 - eta * eta * (1 - d[i].cosine * d[i].cosine))), upwards[i],
                        (1 - d[i].reflected) * d[i].cosine * d[i].weight / entering});
  return shares;
}

inline double halfSpaceAlbedo(double albedo, double eta, int nodes) {
  double leaving = 0;
  for (const LeavingShare& s : halfSpaceShares(albedo, eta, nodes)) leaving += s.share * s.weight;
  return leaving;
}

}  // namespace limn::test
