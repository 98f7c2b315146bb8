#include "core/reference/private/film.h"

#include <tbb/parallel_for.h>

#include <array>
#include <cmath>
#include <limits>

#include "core/reference/private/camera_radiance.h"

namespace limn::reference {
namespace {

// Positions in channelNames(). Factors of a light have three more before A, which is the last.
constexpr size_t kVariance = 3, kDepth = 4, kId = 6, kFactor = 13, kWeightedFactor = 14, kMasked = 15;

struct Mean {
  glm::dvec3 value{0}, deviation{0};  ///< deviation: half the difference of the two halves
};

Mean meanOf(const Integrator& integrator, const Accumulators& state, size_t pixel) {
  const glm::dvec3 a = integrator.estimate(state.sums[2 * pixel], state.samples);
  const glm::dvec3 b = integrator.estimate(state.sums[2 * pixel + 1], state.samples);
  return {0.5 * (a + b), 0.5 * (a - b)};
}

/// V or W of both halves together: samples above the tangent plane are not equally many in each.
double ratioOf(const Accumulators& state, size_t pixel, size_t part) {
  const Sums& a = state.sums[2 * pixel];
  const Sums& b = state.sums[2 * pixel + 1];
  const double all = a[part + 1] + b[part + 1];
  return all > 0 ? (a[part] + b[part]) / all : 1.0;
}

bool isMaskedPixel(const Accumulators& state, size_t pixel) {
  return state.sums[2 * pixel][1] + state.sums[2 * pixel + 1][1] == 0;
}

/// A pixel of the image, rows from the top.
std::span<float> imagePixel(const View& view, Image& image, size_t pixel) {
  const ViewPixel at = view.pixel(pixel);
  return image.pixel(at.x, view.height - 1 - at.y);
}

void writeColour(std::span<float> out, const glm::dvec3& colour, double variance) {
  for (int c = 0; c < 3; ++c) out[static_cast<size_t>(c)] = static_cast<float>(colour[c]);
  out[kVariance] = static_cast<float>(variance);
}

}  // namespace

void View::findHits(const std::stop_token& stop) {
  hits.assign(pixelCount(), {});
  tbb::parallel_for(size_t{0}, pixelCount(), [&](size_t index) {
    if (!stop.stop_requested()) rays.see(frame, near, pixel(index), hits[index]);
  });
}

bool View::surface(size_t index, Surface& surface) const {
  if (!shows(index)) return false;
  surface = surfaceAt(rays, hits[index], frame, pixel(index));
  return true;
}

float View::distance(size_t index) const {
  if (!shows(index)) return std::numeric_limits<float>::max();
  return hits[index].depth * glm::length(rayOf(index));
}

glm::vec3 View::transmittance(size_t index) const {
  return rays.medium().transmittance(glm::vec3(frame.camera_position), direction(index), distance(index));
}

glm::vec3 View::direction(size_t index) const {
  return glm::normalize(rayOf(index));
}

glm::vec3 View::rayOf(size_t index) const {
  const ViewPixel at = pixel(index);
  return viewRay(frame, static_cast<float>(at.x), static_cast<float>(at.y));
}

std::vector<std::string> channelNames(Term term) {
  std::vector<std::string> names{"R",        "G",        "B",        "variance", "Z",   "coverage", "id",
                                 "albedo.R", "albedo.G", "albedo.B", "N.X",      "N.Y", "N.Z"};
  if (term == Term::visibility) names.insert(names.end(), {"V", "Vw", "masked"});
  if (term == Term::relief) names.insert(names.end(), {"W", "Ww", "masked"});
  names.emplace_back("A");
  return names;
}

Image renderFeatures(const View& view, Term term, bool background, const std::stop_token& stop) {
  Image image(view.width, view.height, channelNames(term));
  tbb::parallel_for(size_t{0}, view.pixelCount(), [&](size_t pixel) {
    if (stop.stop_requested()) return;
    const std::span<float> out = imagePixel(view, image, pixel);
    Surface surface;
    if (!view.surface(pixel, surface)) {
      out[kId] = -1.f;  // nobody
      out.back() = background ? 1.f : 0.f;
      return;
    }
    out.back() = 1;
    const glsl::GBufferSurface& values = surface.values;
    const std::array<float, 9> features{surface.depth,
                                        1.f,
                                        static_cast<float>(surface.draw),
                                        values.base_colour.x,
                                        values.base_colour.y,
                                        values.base_colour.z,
                                        values.normal.x,
                                        values.normal.y,
                                        values.normal.z};
    std::copy(features.begin(), features.end(), out.begin() + kDepth);
  });
  return image;
}

std::optional<double> noiseOf(const Integrator& integrator, const Request& request, const Accumulators& state,
                              const std::vector<unsigned char>& counts) {
  glm::dvec3 sum(0), squares(0);
  size_t count = 0;
  for (size_t pixel = 0; pixel < counts.size(); ++pixel) {
    if (!counts[pixel] || (isLightFactor(request.term) && isMaskedPixel(state, pixel))) continue;
    const Mean mean = meanOf(integrator, state, pixel);
    sum += mean.value;
    squares += mean.deviation * mean.deviation;
    ++count;
  }
  if (count == 0) return 0;
  const double total = sum.x + sum.y + sum.z;
  if (!(total > 0)) return std::nullopt;
  const double values = 3.0 * static_cast<double>(count);
  // The aa x aa of a pixel of the result are independent.
  return std::sqrt((squares.x + squares.y + squares.z) / values) / (total / values) / request.aa;
}

void develop(const Integrator& integrator, const View& view, const Request& request,
             const Accumulators& state, Image& image) {
  tbb::parallel_for(size_t{0}, view.pixelCount(), [&](size_t pixel) {
    const std::span<float> out = imagePixel(view, image, pixel);
    if (isLightFactor(request.term)) {
      const double v = ratioOf(state, pixel, 0);
      const glm::dvec3 deviation = meanOf(integrator, state, pixel).deviation;
      writeColour(out, glm::dvec3(v), deviation.x * deviation.x);
      out[kFactor] = static_cast<float>(v);
      out[kWeightedFactor] = static_cast<float>(ratioOf(state, pixel, 2));
      out[kMasked] = isMaskedPixel(state, pixel) ? 1.f : 0.f;
      return;
    }
    Mean mean = meanOf(integrator, state, pixel);
    if (request.term == Term::final) {
      const scene::EnvironmentLight& environment = view.rays.environment();
      Surface surface;
      glm::vec3 seen;
      if (!view.surface(pixel, surface))
        seen = environment.radiance(view.direction(pixel));
      else if (request.interfaces != 0)
        seen = surface.values.emission;
      else
        seen = cameraRadiance(surface, view.rays.draws()[surface.draw], environment);
      mean.value += glm::dvec3(seen * view.transmittance(pixel));
    }
    writeColour(out, mean.value, glm::dot(mean.deviation, mean.deviation) / 3);
  });
}

Image downsample(const Image& image, int aa) {
  if (aa == 1) return image;
  Image result(image.width() / aa, image.height() / aa, image.channels());
  result.metadata() = image.metadata();
  const size_t last = static_cast<size_t>(image.channelCount()) - 1;
  const auto averaged = [&](size_t channel) {
    return channel <= kVariance || channel == kFactor || channel == kWeightedFactor || channel == last;
  };
  for (int y = 0; y < result.height(); ++y)
    for (int x = 0; x < result.width(); ++x) {
      const std::span<float> out = result.pixel(x, y);
      const auto centre = image.pixel(x * aa + aa / 2, y * aa + (aa - 1) / 2);
      for (size_t c = 0; c < out.size(); ++c) {
        double sum = 0;
        for (int i = 0; i < aa * aa; ++i)
          sum += image.at(x * aa + i % aa, y * aa + i / aa, static_cast<int>(c));
        const double mean = sum / (aa * aa);
        out[c] = averaged(c) ? static_cast<float>(c == kVariance ? mean / (aa * aa) : mean) : centre[c];
      }
    }
  return result;
}

}  // namespace limn::reference
