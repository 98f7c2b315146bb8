#include "core/brdf/epfl_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/brdf/measured_file.h"
#include "core/brdf/private/tensor_file.h"
#include "core/brdf/private/visible_normals.h"

namespace limn::brdf {
namespace {

/// Files of isotropic materials have one azimuth of l, or two that say the same.
constexpr std::size_t kMostIsotropic = 2;
/// A whole turn, radians, and the rounding of its ends.
constexpr float kLargestAngle = 6.3f;

// The square of directions: x is sqrt(theta / (pi/2)), y counts the azimuth from -pi.
double polar(double theta) {
  return std::sqrt(theta * (2 / std::numbers::pi));
}
double azimuthal(double phi) {
  const double y = (phi + std::numbers::pi) / (2 * std::numbers::pi);
  return y - std::floor(y);
}

/// Between which of `nodes`, which grow, a number lies.
Cell cellAmong(const std::vector<float>& nodes, double at) {
  Cell cell(0, nodes.size());
  if (nodes.size() > 1) {
    const auto above = std::upper_bound(nodes.begin() + 1, nodes.end() - 1, static_cast<float>(at));
    cell.above = static_cast<std::size_t>(above - nodes.begin());
    cell.below = cell.above - 1;
  }
  const double below = static_cast<double>(nodes[cell.below]), above = static_cast<double>(nodes[cell.above]);
  cell.share = above > below ? std::clamp((at - below) / (above - below), 0.0, 1.0) : 0;
  return cell;
}

/// The azimuths of l that were measured, and how they stand for all others.
class Azimuths {
 public:
  Azimuths() = default;
  Azimuths(std::vector<float> phi, std::string_view name) : phi_(std::move(phi)) {
    if (isotropic()) return;
    for (std::size_t i = 0; i < phi_.size(); ++i)
      if (!(std::abs(phi_[i]) < kLargestAngle && (i == 0 || phi_[i] > phi_[i - 1])))
        throw Error(fmt::format("{}: phi_i[{}] is {}; angles from -2 pi to 2 pi that grow are accepted", name,
                                i, phi_[i]));
    // Rounded, as the format's own readers do: a circle may end a step before it closes.
    const float span = phi_.back() - phi_.front();
    const double parts = std::rint(2 * std::numbers::pi / static_cast<double>(span));
    if (!(span < kLargestAngle) || (parts != 1 && parts != 2 && parts != 4))
      throw Error(fmt::format(
          "{}: phi_i spans {:.3g} radians; a circle, a half or a quarter of one are accepted", name, span));
    period_ = parts == 1 ? 2 * std::numbers::pi : std::numbers::pi;
    mirrored_ = parts == 4;
  }

  std::size_t count() const { return phi_.size(); }
  bool isotropic() const { return phi_.size() <= kMostIsotropic; }
  /// Returns how many of them are told apart.
  std::size_t kept() const { return isotropic() ? 1 : phi_.size(); }
  Cell cell(double phi) const { return cellAmong(phi_, phi); }

  struct Pair {
    double l = 0, h = 0;
  };
  /// Returns azimuths of l and h for which the surface reflects as for those given, and at the first of which
  /// it was measured.
  Pair measured(Pair at) const {
    if (isotropic()) return {.l = 0, .h = at.h - at.l};
    const auto first = static_cast<double>(phi_.front());
    const double turn = period_ * std::floor((at.l - first) / period_);
    at = {.l = at.l - turn, .h = at.h - turn};
    if (!mirrored_ || at.l <= first + std::numbers::pi / 2) return at;
    return {.l = 2 * first + std::numbers::pi - at.l, .h = 2 * first + std::numbers::pi - at.h};
  }

 private:
  std::vector<float> phi_;  ///< phi_i, radians
  double period_ = 2 * std::numbers::pi;
  bool mirrored_ = false;
};

/// The arrays of a file whose sizes agree.
class EpflArrays {
 public:
  EpflArrays(const TensorFile& file, std::string_view name) : name_(name) {
    azimuths_ = Azimuths(file.floats("phi_i", 1).values, name);
    polars_ = file.floats("theta_i", 1).values;
    for (std::size_t i = 0; i < polars_.size(); ++i)
      if (!(polars_[i] >= (i > 0 ? std::nextafter(polars_[i - 1], 2.0f) : 0.0f) && polars_[i] <= 1.6f))
        throw Error(fmt::format("{}: theta_i[{}] is {}; angles from 0 to pi/2 that grow are accepted", name_,
                                i, polars_[i]));
    ndf_ = density(file, "ndf", 2);
    sigma_ = density(file, "sigma", 2);
    visible(density(file, "vndf", 4));
    colours(file);
  }

  bool isotropic() const { return azimuths_.isotropic(); }

  /// f for light from l. The files' data is not quite reciprocal.
  glm::vec3 evaluate(const glm::vec3& l, const glm::vec3& v) const {
    const glm::dvec3 from(l), h = glm::normalize(from + glm::dvec3(v));
    const double thetaL = std::atan2(std::hypot(from.x, from.y), from.z);
    const Azimuths::Pair phi =
        azimuths_.measured({.l = std::atan2(from.y, from.x), .h = std::atan2(h.y, h.x)});
    const glm::dvec2 normal(polar(std::atan2(std::hypot(h.x, h.y), h.z)), azimuthal(phi.h));
    const Cell theta = cellAmong(polars_, thetaL);
    const Mix mix = isotropic() ? Mix(theta) : Mix(azimuths_.cell(phi.l), theta, polars_.size());
    const glm::dvec2 u = normals_.invert(normal, mix);
    const double scale =
        at(ndf_, normal) / (4 * at(sigma_, {polar(thetaL), azimuthal(phi.l)}) * static_cast<double>(v.z));
    const Cell x(u.x, coloursSize_.width), y(u.y, coloursSize_.height);
    glm::dvec3 rgb;
    for (int channel = 0; channel < 3; ++channel) {
      const auto plane = [&](std::size_t grid) {
        const std::size_t first = (grid * 3 + static_cast<std::size_t>(channel)) * coloursSize_.count();
        return bilinear(std::span<const float>(colours_).subspan(first), coloursSize_, x, y);
      };
      rgb[channel] = std::max(mix.of(plane), 0.0);  // colours outside the gamut are negative
    }
    return glm::vec3(rgb * scale);
  }

 private:
  static double at(const Tensor& grid, const glm::dvec2& place) {
    const GridSize size{.width = grid.shape[1], .height = grid.shape[0]};
    return bilinear(std::span<const float>(grid.values), size, Cell(place.x, size.width),
                    Cell(place.y, size.height));
  }

  Tensor density(const TensorFile& file, std::string_view field, std::size_t dimensions) const {
    Tensor tensor = file.floats(field, dimensions);
    for (const float value : tensor.values)
      if (!(value >= 0 && std::isfinite(value)))
        throw Error(
            fmt::format("{}: array '{}' holds {}; numbers of at least 0 are accepted", name_, field, value));
    return tensor;
  }

  /// Whether an array begins with the azimuths and polar angles of l, and ends with a grid of two nodes or
  /// more a side.
  void requireShape(std::string_view field, const Tensor& tensor) const {
    const std::size_t width = tensor.shape.back(), height = tensor.shape[tensor.shape.size() - 2];
    if (tensor.shape[0] != azimuths_.count() || tensor.shape[1] != polars_.size() || width < 2 || height < 2)
      throw Error(fmt::format(
          "{}: array '{}' is {} x {} grids of {} x {}; {} x {} (phi_i, theta_i) of at least 2 x 2 are "
          "accepted",
          name_, field, tensor.shape[0], tensor.shape[1], height, width, azimuths_.count(), polars_.size()));
  }

  void visible(const Tensor& vndf) {
    requireShape("vndf", vndf);
    const GridSize size{.width = vndf.shape[3], .height = vndf.shape[2]};
    const std::size_t kept = azimuths_.kept() * polars_.size();
    std::vector<double> densities(kept * size.count());
    for (std::size_t i = 0; i < azimuths_.count() * polars_.size(); ++i) {
      const std::span<const float> grid = std::span(vndf.values).subspan(i * size.count(), size.count());
      double sum = 0;
      for (const float value : grid) sum += static_cast<double>(value);
      if (!(sum > 0)) throw Error(fmt::format("{}: array 'vndf' is 0 everywhere at one theta_i", name_));
      double* mean = &densities[i % kept * size.count()];
      for (std::size_t k = 0; k < size.count(); ++k) mean[k] += static_cast<double>(grid[k]) / sum;
    }
    normals_ = VisibleNormals(densities, size);
  }

  void colours(const TensorFile& file) {
    const Tensor rgb = file.floats("rgb", 5);
    requireShape("rgb", rgb);
    if (rgb.shape[2] != 3)
      throw Error(fmt::format("{}: array 'rgb' has {} channels; 3 are accepted", name_, rgb.shape[2]));
    coloursSize_ = {.width = rgb.shape[4], .height = rgb.shape[3]};
    const std::size_t averaged = azimuths_.count() / azimuths_.kept();
    colours_.assign(rgb.values.size() / averaged, 0);
    for (std::size_t i = 0; i < rgb.values.size(); ++i) {
      if (!std::isfinite(rgb.values[i]))
        throw Error(
            fmt::format("{}: array 'rgb' holds {}; finite numbers are accepted", name_, rgb.values[i]));
      colours_[i % colours_.size()] += rgb.values[i] / static_cast<float>(averaged);
    }
  }

  std::string name_;
  Azimuths azimuths_;
  std::vector<float> polars_;  ///< theta_i, radians
  Tensor ndf_, sigma_;
  VisibleNormals normals_;
  GridSize coloursSize_;
  std::vector<float> colours_;  ///< three grids for each of theta_i, at each azimuth that is kept
};

}  // namespace

MeasuredBrdf decodeEpfl(std::span<const std::byte> bytes, std::string_view name, const EpflNodes& nodes) {
  const EpflArrays measured(TensorFile(bytes, name), name);
  const auto f = [&](const glm::vec3& l, const glm::vec3& v) { return measured.evaluate(l, v); };
  try {
    if (measured.isotropic()) return tabulate(nodes.angles, f);
    return tabulateReciprocal(nodes.texels, f);
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", name, error.what()));
  }
}

}  // namespace limn::brdf
