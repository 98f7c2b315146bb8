// Declares the lobes by which a point's incident light leaves it.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/base/export.h"
#include "glsl/indirect/illumination_sample.glsl"
#include "glsl/surface/brdf.glsl"

namespace limn::radiosity {

/// The sum of one lobe per incident light: L(w) = sum f(w_k, w) (n.w_k)+ E_k, in the frame n = +z, for the
/// specular part of the BRDF. Lobes of lights that spread are widened, and keep their energy.
class LIMN_API GlossyLobes {
 public:
  /// Sets the lobes of the specular part. Directions are in the local frame; lights below the horizon and
  /// black ones get no lobe. `widen`: see glsl::widened_alpha; 0: none. Memory is kept.
  void set(const glsl::SurfaceBrdf& surface, std::span<const glsl::IncidentLight> lights, float widen);

  size_t size() const { return count_; }
  /// Returns the lobes' sum in direction w, unit, w.z > 0.
  glm::vec3 radiance(const glm::vec3& w) const;
  /// Returns what the lobes carry together, W/m^2: by the reflectance of the LTC table.
  const glm::vec3& flux() const { return flux_; }

  /// Returns the length of the rows in which numbers of lobes stand: a multiple of four.
  static size_t stride(size_t count) { return (count + 3) / 4 * 4; }
  /// Returns the number of rows that describe lobes.
  static size_t rows() { return kRows; }
  /// Describes some lobes in rows() rows of stride(which.size()) numbers.
  void describe(std::span<const uint32_t> which, float* rows) const;
  /// Returns the sum of some lobes in direction w, unit, w.z > 0, which describe() has described. Puts their
  /// values in `values`, if not null: a row for each channel.
  glm::vec3 evaluate(const glm::vec3& w, std::span<const uint32_t> which, const float* rows,
                     float* values) const;

  /// Returns the mirror direction of a lobe.
  const glm::vec3& mirror(size_t k) const { return lobes_[k].mirror; }
  /// Returns the GGX width of a lobe.
  float alpha(size_t k) const { return lobes_[k].alpha; }
  /// Returns what a lobe carries, luminance, W/m^2.
  float brightness(size_t k) const { return lobes_[k].brightness; }

 private:
  /// x, y, z of the light, alpha^2, sqrt(z^2 (1 - alpha^2) + alpha^2), and for each channel E z a(alpha) /
  /// a(alpha_k) times f0 and times f90.
  static constexpr size_t kRows = 11;
  struct Lobe {
    glm::vec3 mirror;
    float alpha, brightness;
  };

  size_t count_ = 0;
  std::vector<Lobe> lobes_;
  std::vector<uint32_t> all_;  ///< 0, 1, 2, ...
  std::vector<float> rows_;    ///< of all lobes, in rows of rowLength_
  size_t rowLength_ = 0;
  glm::vec3 flux_{0};
};

}  // namespace limn::radiosity
