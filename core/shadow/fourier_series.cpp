// The numbers behind the Fourier series of the shadow test.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/error.h"
#include "core/shadow/fourier_maps.h"

namespace limn::shadow {
namespace {

using std::numbers::pi;

double factor(int k, int order, FourierWindow window) {
  const double u = (2 * k - 1) / (2.0 * order);
  if (window == FourierWindow::lanczos) return std::sin(pi * u) / (pi * u);
  return window == FourierWindow::fejer ? 1 - u : 1;
}

/// A root of g between a and b, where it changes sign.
template <class Function>
double root(double a, double b, const Function& g) {
  const bool rising = g(a) < 0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (a + b);
    ((g(middle) < 0) == rising ? a : b) = middle;
  }
  return 0.5 * (a + b);
}

/// Mean of S(delta + t), t uniform in [-half, half].
double meanAcross(double delta, double half, int order, FourierWindow window) {
  double mean = 0.5;
  for (int k = 1; k <= order; ++k) {
    const double c = pi * (2 * k - 1);
    mean += 2 * factor(k, order, window) / c * std::sin(c * delta) * std::sin(c * half) / (c * half);
  }
  return mean;
}

}  // namespace

double fourierSeries(double x, int order, FourierWindow window) {
  double s = 0.5;
  for (int k = 1; k <= order; ++k) {
    const double c = pi * (2 * k - 1);
    s += 2 * factor(k, order, window) / c * std::sin(c * x);
  }
  return s;
}

FourierConstants fourierConstants(int order, FourierWindow window) {
  if (order < 1 || order > 64)
    throw UsageError(fmt::format("Fourier series of {} terms: accepted are 1 to 64", order));
  const auto series = [&](double x) { return fourierSeries(x, order, window); };
  // S is symmetric about 1/2, and its extrema are no closer than about 1 / (2 M).
  const double step = 1.0 / (512.0 * order);
  FourierConstants c;
  // Fejer's series rises all the way and never reaches 1: from its first flat place on it is as good as it
  // gets.
  c.delta = std::min(1.0 / order, 0.25);
  for (double x = step; x <= 0.5; x += step) {
    if (series(x) < 1) continue;
    c.delta = root(x - step, x, [&](double at) { return series(at) - 1; });
    break;
  }
  c.range = 1 - 2 * c.delta;
  c.level = series(c.delta);
  c.dip = c.level;
  c.valley = c.delta;
  double most = series(0.5);
  for (double x = c.delta; x <= 0.5; x += step) {
    most = std::max(most, series(x));
    if (series(x) >= c.dip) continue;
    c.dip = series(x);
    c.valley = x;
  }
  double low = c.valley - step, high = c.valley + step;  // of a section in which S has one least value
  for (int i = 0; i < 60 && c.valley > c.delta; ++i) {
    const double third = (high - low) / 3;
    if (series(low + third) < series(high - third)) {
      high -= third;
    } else {
      low += third;
    }
  }
  if (c.valley > c.delta) c.dip = series(c.valley = std::min(0.5 * (low + high), 0.5));
  c.overshoot = most - 1;
  c.gain = 0.5 / (c.dip - 0.5);
  // The mean falls steadily up to there: the texels before the receiver lose more than those behind it gain.
  for (double half = step; half < c.delta; half += step) {
    const double mean = meanAcross(c.delta, half, order, window);
    if (mean < c.dip) break;
    c.tolerance = half;
    c.curvature = std::max(c.curvature, (c.level - mean) / (half * half));
  }
  return c;
}

double fourierNoise(int order, FourierWindow window, int scale) {
  double bound = 0;
  for (int k = 1; k <= order; ++k) bound += 2 * factor(k, order, window) / (pi * (2 * k - 1));
  return bound * std::numbers::sqrt2 * 0.5 / scale;
}

}  // namespace limn::shadow
