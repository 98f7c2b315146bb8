#include "core/brdf/epfl_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/brdf/measured_file.h"
#include "core/brdf/private/tensor_file.h"
#include "core/brdf/private/visible_normals.h"

namespace limn::brdf {
namespace {

constexpr double kPi = std::numbers::pi;
/// Files of isotropic materials have one azimuth of l, or two that say the same.
constexpr std::size_t kMostAzimuths = 2;

// The square of directions: x is sqrt(theta / (pi/2)), y counts the azimuth from -pi.
double polar(double theta) {
  return std::sqrt(theta * (2 / kPi));
}
double azimuthal(double phi) {
  const double y = (phi + kPi) / (2 * kPi);
  return y - std::floor(y);
}

/// The arrays of a file whose sizes agree.
class EpflArrays {
 public:
  EpflArrays(const TensorFile& file, std::string_view name) : name_(name) {
    const Tensor azimuths = file.floats("phi_i", 1);
    polars_ = file.floats("theta_i", 1).values;
    if (azimuths.values.size() > kMostAzimuths)
      throw Error(fmt::format("{}: an anisotropic BRDF, measured at {} azimuths; isotropic ones are accepted",
                              name_, azimuths.values.size()));
    for (std::size_t i = 0; i < polars_.size(); ++i)
      if (!(polars_[i] >= (i > 0 ? std::nextafter(polars_[i - 1], 2.0f) : 0.0f) && polars_[i] <= 1.6f))
        throw Error(fmt::format("{}: theta_i[{}] is {}; angles from 0 to pi/2 that grow are accepted", name_,
                                i, polars_[i]));
    ndf_ = density(file, "ndf", 2);
    sigma_ = density(file, "sigma", 2);
    visible(density(file, "vndf", 4), azimuths.values.size());
    colours(file, azimuths.values.size());
  }

  /// f for light from l. The files' data is not quite reciprocal.
  glm::vec3 evaluate(const glm::vec3& l, const glm::vec3& v) const {
    const glm::dvec3 from(l), h = glm::normalize(from + glm::dvec3(v));
    const double thetaL = std::atan2(std::hypot(from.x, from.y), from.z);
    const double phiL = std::atan2(from.y, from.x);
    const glm::dvec2 normal(polar(std::atan2(std::hypot(h.x, h.y), h.z)),
                            azimuthal(std::atan2(h.y, h.x) - phiL));
    const Cell parameter = parameterAt(thetaL);
    const glm::dvec2 u = normals_.invert(normal, parameter);
    const double scale =
        at(ndf_, normal) / (4 * at(sigma_, {polar(thetaL), azimuthal(0)}) * static_cast<double>(v.z));
    const Cell x(u.x, coloursSize_.width), y(u.y, coloursSize_.height);
    glm::dvec3 rgb;
    for (int channel = 0; channel < 3; ++channel) {
      const auto plane = [&](std::size_t slice) {
        const std::size_t first = (slice * 3 + static_cast<std::size_t>(channel)) * coloursSize_.count();
        return bilinear(std::span<const float>(colours_).subspan(first), coloursSize_, x, y);
      };
      // Colours outside the gamut are negative.
      rgb[channel] = std::max(
          (1 - parameter.share) * plane(parameter.below) + parameter.share * plane(parameter.above), 0.0);
    }
    return glm::vec3(rgb * scale);
  }

 private:
  static double at(const Tensor& grid, const glm::dvec2& place) {
    const GridSize size{.width = grid.shape[1], .height = grid.shape[0]};
    return bilinear(std::span<const float>(grid.values), size, Cell(place.x, size.width),
                    Cell(place.y, size.height));
  }

  /// Between which of theta_i an angle lies.
  Cell parameterAt(double theta) const {
    Cell cell(0, polars_.size());
    while (cell.above + 1 < polars_.size() && static_cast<double>(polars_[cell.above]) <= theta) {
      ++cell.below;
      ++cell.above;
    }
    const double below = static_cast<double>(polars_[cell.below]),
                 above = static_cast<double>(polars_[cell.above]);
    cell.share = above > below ? std::clamp((theta - below) / (above - below), 0.0, 1.0) : 0;
    return cell;
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
  void requireShape(std::string_view field, const Tensor& tensor, std::size_t azimuths) const {
    const std::size_t width = tensor.shape.back(), height = tensor.shape[tensor.shape.size() - 2];
    if (tensor.shape[0] != azimuths || tensor.shape[1] != polars_.size() || width < 2 || height < 2)
      throw Error(fmt::format(
          "{}: array '{}' is {} x {} grids of {} x {}; {} x {} (phi_i, theta_i) of at least 2 x 2 are "
          "accepted",
          name_, field, tensor.shape[0], tensor.shape[1], height, width, azimuths, polars_.size()));
  }

  void visible(const Tensor& vndf, std::size_t azimuths) {
    requireShape("vndf", vndf, azimuths);
    const GridSize size{.width = vndf.shape[3], .height = vndf.shape[2]};
    std::vector<double> densities(polars_.size() * size.count());
    for (std::size_t i = 0; i < azimuths * polars_.size(); ++i) {
      const std::span<const float> grid = std::span(vndf.values).subspan(i * size.count(), size.count());
      double sum = 0;
      for (const float value : grid) sum += static_cast<double>(value);
      if (!(sum > 0)) throw Error(fmt::format("{}: array 'vndf' is 0 everywhere at one theta_i", name_));
      double* mean = &densities[i % polars_.size() * size.count()];
      for (std::size_t k = 0; k < size.count(); ++k) mean[k] += static_cast<double>(grid[k]) / sum;
    }
    normals_ = VisibleNormals(densities, size);
  }

  void colours(const TensorFile& file, std::size_t azimuths) {
    const Tensor rgb = file.floats("rgb", 5);
    requireShape("rgb", rgb, azimuths);
    if (rgb.shape[2] != 3)
      throw Error(fmt::format("{}: array 'rgb' has {} channels; 3 are accepted", name_, rgb.shape[2]));
    coloursSize_ = {.width = rgb.shape[4], .height = rgb.shape[3]};
    colours_.assign(rgb.values.size() / azimuths, 0);
    for (std::size_t i = 0; i < rgb.values.size(); ++i) {
      if (!std::isfinite(rgb.values[i]))
        throw Error(
            fmt::format("{}: array 'rgb' holds {}; finite numbers are accepted", name_, rgb.values[i]));
      colours_[i % colours_.size()] += rgb.values[i] / static_cast<float>(azimuths);
    }
  }

  std::string name_;
  std::vector<float> polars_;  ///< theta_i, radians
  Tensor ndf_, sigma_;
  VisibleNormals normals_;
  GridSize coloursSize_;
  std::vector<float> colours_;  ///< for each of theta_i three grids
};

}  // namespace

TabulatedBrdf decodeEpfl(std::span<const std::byte> bytes, std::string_view name, const glm::ivec3& size) {
  const EpflArrays measured(TensorFile(bytes, name), name);
  try {
    return tabulate(size, [&](const glm::vec3& l, const glm::vec3& v) { return measured.evaluate(l, v); });
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", name, error.what()));
  }
}

TabulatedBrdf readEpfl(const std::filesystem::path& path, const glm::ivec3& size) {
  return decodeEpfl(readFile(path, kLargestMeasuredFile), path.string(), size);
}

}  // namespace limn::brdf
