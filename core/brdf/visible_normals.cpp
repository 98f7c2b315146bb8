#include "core/brdf/private/visible_normals.h"

namespace limn::brdf {

VisibleNormals::VisibleNormals(std::span<const double> densities, const GridSize& size)
    : size_(size),
      densities_(densities.begin(), densities.end()),
      rows_(densities.size()),
      columns_(densities.size() / size.width) {
  const std::size_t width = size.width, height = size.height;
  for (std::size_t first = 0; first < densities.size(); first += size.count()) {
    for (std::size_t row = first; row < first + size.count(); row += width)
      for (std::size_t x = 1; x < width; ++x)
        rows_[row + x] = rows_[row + x - 1] + 0.5 * (densities_[row + x - 1] + densities_[row + x]);
    double* columns = &columns_[first / width];
    const auto whole = [&](std::size_t y) { return rows_[first + y * width + width - 1]; };
    for (std::size_t y = 1; y < height; ++y) columns[y] = columns[y - 1] + 0.5 * (whole(y - 1) + whole(y));
    const double factor = 1 / columns[height - 1];
    for (std::size_t i = first; i < first + size.count(); ++i) {
      densities_[i] *= factor;
      rows_[i] *= factor;
    }
    for (std::size_t y = 0; y < height; ++y) columns[y] *= factor;
  }
}

glm::dvec2 VisibleNormals::invert(const glm::dvec2& place, const Mix& mix) const {
  const Cell x(place.x, size_.width), y(place.y, size_.height);
  const auto mixed = [&](const std::vector<double>& of, std::size_t stride, std::size_t at) {
    return mix.of([&](std::size_t grid) { return of[grid * stride + at]; });
  };
  const auto node = [&](const std::vector<double>& of, std::size_t column, std::size_t row) {
    return mixed(of, size_.count(), row * size_.width + column);
  };
  const auto across = [&](const std::vector<double>& of, std::size_t column) {
    return (1 - y.share) * node(of, column, y.below) + y.share * node(of, column, y.above);
  };
  // The integral of a linear density over the first part of a cell.
  const auto part = [](double share, double below, double above) {
    return share * (below + 0.5 * share * (above - below));
  };
  const std::size_t last = size_.width - 1;
  const double whole = across(rows_, last);
  const double along =
      across(rows_, x.below) + part(x.share, across(densities_, x.below), across(densities_, x.above));
  const double up = mixed(columns_, size_.height, y.below) +
                    part(y.share, node(rows_, last, y.below), node(rows_, last, y.above));
  return {whole > 0 ? along / whole : place.x, up};
}

}  // namespace limn::brdf
