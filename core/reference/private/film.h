// Turns accumulated samples into pictures.
#pragma once

#include <optional>
#include <stop_token>
#include <vector>

#include "core/reference/private/checkpoint.h"
#include "core/reference/private/integrator.h"

namespace limn::reference {

/// Holds the camera and the pixels, with aa x aa of them per pixel of the result. Pixels are numbered y *
/// width + x from the lower left.
struct View {
  const RayScene& rays;
  glsl::FrameBlock frame{};
  float near = 0;
  int width = 0, height = 0;
  int aa = 1;
  std::vector<Hit> hits{};  ///< of every pixel, once findHits() has been called; of depth 0: nothing is seen

  size_t pixelCount() const { return static_cast<size_t>(width) * static_cast<size_t>(height); }
  ViewPixel pixel(size_t index) const {
    return {static_cast<int>(index % static_cast<size_t>(width)),
            static_cast<int>(index / static_cast<size_t>(width)), aa};
  }
  /// Finds what every pixel shows. When asked to stop, it returns with what is found.
  void findHits(const std::stop_token& stop);
  /// Returns whether a pixel shows a surface.
  bool shows(size_t index) const { return hits[index].depth > 0; }
  /// Evaluates the surface that pixel `index` shows; returns false if there is none.
  bool surface(size_t index, Surface& surface) const;
  /// Returns the pixel's view ray; its component along the camera's axis is 1.
  glm::vec3 rayOf(size_t index) const;
  /// Returns its unit direction.
  glm::vec3 direction(size_t index) const;
  /// Returns the distance to what the pixel shows, metres; the largest number where that is nothing.
  float distance(size_t index) const;
  /// Returns T_cam, the medium's transmittance from there to the camera.
  glm::vec3 transmittance(size_t index) const;
};

/// Returns the names of the channels of a result, in their order.
std::vector<std::string> channelNames(Term term);

/// Returns the values that the G-buffer would hold for what pixels show: Z, coverage, id, albedo, normal,
/// rows from the top, behind empty channels R, G, B and variance; and A, the last channel, where `background`
/// says whether something shows without a surface. When asked to stop, it returns what is finished.
Image renderFeatures(const View& view, Term term, bool background, const std::stop_token& stop);

/// Returns the RMS of the standard deviation of the mean of the result's pixels, over those that count (for
/// factors of a light: those not masked) and channels, relative to the mean; 0 where none counts, nullopt
/// where the mean is 0.
std::optional<double> noiseOf(const Integrator& integrator, const Request& request, const Accumulators& state,
                              const std::vector<unsigned char>& counts);

/// Writes the channels that the samples determine into the features' image.
void develop(const Integrator& integrator, const View& view, const Request& request,
             const Accumulators& state, Image& image);

/// Averages aa x aa pixels; the G-buffer's channels other than A are those of the centre pixel (of four: the
/// upper right).
Image downsample(const Image& image, int aa);

}  // namespace limn::reference
