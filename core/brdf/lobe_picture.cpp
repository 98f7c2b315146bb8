#include "core/brdf/lobe_picture.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <span>
#include <vector>

#include "core/brdf/factor_fit_error.h"

namespace limn::brdf {
namespace {

using glm::dvec2;
using glm::dvec3;
using glm::ivec2;

constexpr int kLobes = static_cast<int>(std::size(kLobeAngles));
/// Azimuths of the light: -x and -y.
constexpr double kFrom[] = {std::numbers::pi, -std::numbers::pi / 2};
/// Degrees between the views of the furnace, the last of which is just above the horizon.
constexpr int kFurnaceStep = 3;
constexpr double kLastView = 89.5;
constexpr float kBackground = 0.04f;

/// The direction that Lambert's projection puts at a place of the unit disc.
dvec3 fromDisc(const dvec2& p) {
  const double r2 = glm::dot(p, p);
  return {p * std::sqrt(2 - r2), 1 - r2};
}
dvec2 ontoDisc(const dvec3& d) {
  return dvec2(d) / std::sqrt(1 + d.z);
}

void paint(Image& picture, const ivec2& at, const dvec3& colour) {
  if (at.x < 0 || at.y < 0 || at.x >= picture.width() || at.y >= picture.height()) return;
  for (int channel = 0; channel < 3; ++channel)
    picture.at(at.x, at.y, channel) = static_cast<float>(colour[channel]);
}

/// Calls `draw(pixel, v)` for the pixels of a disc, given from the corner of its square of `side` pixels, and
/// their directions.
template <class Draw>
void forDisc(int side, const Draw& draw) {
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const dvec3 v = fromDisc((2.0 * dvec2(x, side - 1 - y) + 1.0) / static_cast<double>(side) - 1.0);
      if (v.z > 0) draw(ivec2(x, y), v);
    }
}

/// Draws f cos(l), unscaled. Returns its largest channel.
double drawLobe(Image& picture, const ivec2& corner, int side, const Response& response, const dvec3& l) {
  double largest = 0;
  forDisc(side, [&](const ivec2& pixel, const dvec3& v) {
    const dvec3 f = response(l, v);
    paint(picture, corner + pixel, f);
    largest = std::max({largest, f.x, f.y, f.z});
  });
  return largest;
}

/// Makes of each pixel's largest channel the root of its share of `largest`, and keeps its hue.
void compress(Image& picture, const ivec2& corner, int side, double largest) {
  forDisc(side, [&](const ivec2& place, const dvec3&) {
    const std::span<float> pixel = picture.pixel(corner.x + place.x, corner.y + place.y);
    const float most = std::max({pixel[0], pixel[1], pixel[2]});
    if (!(most > 0)) return;
    for (float& value : pixel) value *= std::sqrt(most / static_cast<float>(largest)) / most;
  });
}

/// Draws a grey ring where the light comes from.
void drawLight(Image& picture, const ivec2& corner, int side, const dvec3& l) {
  const dvec2 at = (ontoDisc(l) * dvec2(1, -1) + 1.0) * (0.5 * side);
  const double radius = 0.025 * side;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      if (std::abs(glm::distance(dvec2(x, y) + 0.5, at) - radius) < 0.7)
        paint(picture, corner + ivec2(x, y), dvec3(0.4));
}

/// The albedo over the angle of the view, at multiples of kFurnaceStep.
class Furnace {
 public:
  Furnace(const Response& response, double azimuth) {
    for (int degrees = 0; degrees <= 90; degrees += kFurnaceStep)
      albedos_.push_back(
          albedoOfResponse(response, directionAt(std::min<double>(degrees, kLastView), azimuth)));
  }
  dvec3 at(double degrees) const {
    const double place = std::clamp(degrees, 0.0, 90.0) / kFurnaceStep;
    const std::size_t below = std::min(static_cast<std::size_t>(place), albedos_.size() - 2);
    return glm::mix(albedos_[below], albedos_[below + 1], place - static_cast<double>(below));
  }
  double largest() const {
    double most = 0;
    for (const dvec3& albedo : albedos_) most = std::max({most, albedo.x, albedo.y, albedo.z});
    return most;
  }

 private:
  std::vector<dvec3> albedos_;
};

/// A diagram over the whole width, `height` pixels from `top`.
class Strip {
 public:
  Strip(Image& picture, int top, int height, double most)
      : picture_(picture), top_(top), height_(height), most_(most) {
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < picture.width(); ++x) paint(picture, {x, top + y}, dvec3(0));
    const auto drawLevel = [&](double albedo, double brightness) {
      for (int x = 0; x < picture.width(); ++x) paint(picture, {x, top + row(albedo)}, dvec3(brightness));
    };
    // Less than two rows apart they would fill the strip, and of values up to kLargestValue there are
    // billions.
    if (8 * most <= height - 3)
      for (int quarter = 0; quarter <= 4 * most; ++quarter) drawLevel(quarter / 4.0, 0.08);
    drawLevel(1, 0.4);
    for (const int degrees : kLobeAngles)
      for (int y = 0; y < height; ++y) paint(picture, {degrees * picture.width() / 90, top + y}, dvec3(0.08));
  }

  void draw(const Furnace& furnace, double brightness) {
    for (int x = 0; x < picture_.width(); ++x) {
      const double width = picture_.width();
      const dvec3 left = furnace.at(90.0 * x / width), right = furnace.at(90.0 * (x + 1) / width);
      for (int channel = 0; channel < 3; ++channel) {
        const int one = row(left[channel]), other = row(right[channel]);
        for (int y = std::min(one, other) - 1; y <= std::max(one, other) + 1; ++y) {
          if (y < 0 || y >= height_) continue;
          // Lines of other channels stay: where they meet, their colours add.
          float& value = picture_.at(x, top_ + y, channel);
          value = std::max(value, static_cast<float>(brightness));
        }
      }
    }
  }

 private:
  int row(double albedo) const { return height_ - 2 - static_cast<int>(albedo / most_ * (height_ - 3)); }

  Image& picture_;
  int top_, height_;
  double most_;
};

}  // namespace

dvec3 directionAt(double degrees, double azimuth) {
  const double theta = degrees * std::numbers::pi / 180;
  return {std::sin(theta) * std::cos(azimuth), std::sin(theta) * std::sin(azimuth), std::cos(theta)};
}

Response responseOf(const Brdf& brdf) {
  return [brdf](const dvec3& l, const dvec3& v) { return brdf(l, v) * l.z; };
}

double reciprocityDefect(const Brdf& brdf) {
  double differences = 0, squares = 0;
  for (int degrees = 5; degrees <= 80; degrees += 15)
    for (int azimuth = 0; azimuth < 4; ++azimuth) {
      const dvec3 view = directionAt(degrees, azimuth * std::numbers::pi / 4 + 0.1);
      const double weight = view.z * std::sqrt(1 - view.z * view.z);
      const dvec3 sums = albedoOfResponse(
          [&](const dvec3& l, const dvec3& v) {
            const dvec3 there = brdf(l, v), difference = there - brdf(v, l);
            return dvec3(glm::dot(difference, difference), glm::dot(there, there), 0) * l.z;
          },
          view);
      differences += weight * sums.x;
      squares += weight * sums.y;
    }
  return squares > 0 ? std::sqrt(differences / squares) : 0;
}

Image lobePicture(const Brdf& brdf, bool isotropic, int discPixels) {
  const int margin = std::max(discPixels / 20, 1), cell = discPixels + margin, rows = isotropic ? 1 : 2;
  const int strip = discPixels;
  Image picture = Image::rgb(kLobes * cell + margin, rows * cell + margin + strip);
  std::fill(picture.data().begin(), picture.data().end(), kBackground);
  const Response response = responseOf(brdf);
  double largest = 0;
  const auto forDiscs = [&](const auto& draw) {
    for (int row = 0; row < rows; ++row)
      for (int i = 0; i < kLobes; ++i)
        draw(ivec2(margin + i * cell, margin + row * cell), directionAt(kLobeAngles[i], kFrom[row]));
  };
  forDiscs([&](const ivec2& corner, const dvec3& l) {
    largest = std::max(largest, drawLobe(picture, corner, discPixels, response, l));
  });
  forDiscs([&](const ivec2& corner, const dvec3& l) {
    compress(picture, corner, discPixels, largest);
    drawLight(picture, corner, discPixels, l);
  });

  const Furnace along(response, 0), across(response, isotropic ? 0 : std::numbers::pi / 2);
  Strip furnace(picture, rows * cell + margin, strip, std::max({1.1, along.largest(), across.largest()}));
  if (!isotropic) furnace.draw(across, 0.2);
  furnace.draw(along, 1);
  return picture;
}

}  // namespace limn::brdf
