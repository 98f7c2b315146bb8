// Declares tables of few dimensions that a BRDF is a product of, their look-up on the CPU as a GPU filters
// it, and the tables of the Torrance-Sparrow model.
#pragma once

#include <cstddef>
#include <functional>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "core/base/export.h"

namespace limn::brdf {

/// Returns f(l, v) in 1/sr, per channel; both directions are unit vectors of the local frame (n = +z) above
/// the surface.
using Brdf = std::function<glm::dvec3(const glm::dvec3& l, const glm::dvec3& v)>;
/// The same times the cosine of l: what a light's radiance times its solid angle is multiplied with.
using Response = std::function<glm::dvec3(const glm::dvec3& l, const glm::dvec3& v)>;

/// Says how a table's values are kept: 32 or 16 bits of floating point, or 8 bits for values of [0, 1].
enum class TableFormat { float32, half, byte };

/// Is a texture of colours on the CPU: width x height texels, and `depth` layers or slices, x running
/// fastest.
struct LIMN_API FactorTable {
  int width = 0, height = 1, depth = 1;
  TableFormat format = TableFormat::float32;
  std::vector<glm::vec3> texels;

  /// Makes a table whose texel at each place (of [0, 1]^3, see glsl/materials/factored.glsl; 0 along an axis
  /// of one texel) is what `value` returns there, rounded as `format` keeps it.
  static FactorTable of(const glm::ivec3& size, TableFormat format,
                        const std::function<glm::dvec3(const glm::dvec3& place)>& value);

  /// Gives texel (x, y) of layer z.
  const glm::vec3& at(int x, int y, int z) const { return texels[index(x, y, z)]; }
  glm::vec3& at(int x, int y, int z) { return texels[index(x, y, z)]; }
  /// Rounds all values to what `format` keeps.
  void round();
  /// Returns the memory of three channels.
  std::size_t bytes() const;

 private:
  std::size_t index(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(height) + static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
};

/// Names the product that is taken of the tables; each is a function of glsl/materials/factored.glsl.
enum class Factorisation {
  tables,    ///< T1(h.l, n.h) T2(n.l, n.v), two tables
  dfg,       ///< sum of exp(D + F + G + G), one table of three rows; a layer for each product
  pqp,       ///< sum of exp(p + q + p) over cosines, one table of two rows; a layer for each product
  pqp_disc,  ///< the same over directions, one table of two layers for each product
  dfg_disc,  ///< dfg with D and G over directions, as pqp_disc, and a table of F's rows
  svd,  ///< sum of products of a function of the half vector and one of the difference, two tables of layers
  trilinear,  ///< no factors: one table over half vector and difference
  slopes,     ///< D over the half vector's direction, and rows of Fresnel's term and masking: two tables
  fibres      ///< one table over l.t and v.t
};

/// Is a BRDF as a shader reads it: f n.l is `scale` times the product of the tables, plus `floor` n.l.
struct LIMN_API FactoredBrdf {
  Factorisation factorisation = Factorisation::tables;
  bool warped = true;  ///< of `tables`, `slopes` and `pqp_disc`: texels lie over square roots
  std::string name;    ///< method and sizes, for tables of results
  std::vector<FactorTable> tables;
  glm::dvec3 scale{1};
  glm::dvec3 floor{0};       ///< the diffuse part of f, 1/sr
  glm::vec2 alpha{1};        ///< of `slopes`: roughness along the tangent and across it
  bool independent = false;  ///< of `slopes`: masking is the product of both directions'
  /// From what was fitted, over a picture under held-out lights (factor_fit_error.h); 0 where nothing was
  /// fitted.
  double error = 0;

  /// Returns f n.l, 1/sr; 0 where l is not above the surface or v is below it.
  glm::dvec3 evaluate(const glm::dvec3& l, const glm::dvec3& v) const;
  /// Returns the memory of the tables.
  std::size_t bytes() const;
};

enum class NormalDistribution {
  beckmann,
  gaussian  ///< of the angle between n and h
};
enum class Masking {
  correlated,  ///< Smith's, of both directions at one height
  product      ///< of the two directions taken alone
};

/// Names what stands for the reflectance of the microfacets.
enum class FresnelTerm {
  exact,   ///< Fresnel's equations
  schlick  ///< Schlick's approximation (1994) from the exact value at normal incidence
};

/// Describes a rough specular reflector (Torrance and Sparrow 1967).
struct TorranceSparrow {
  glm::dvec3 eta{1.5};     ///< index of refraction
  glm::dvec3 k{0};         ///< its absorption; 0 for dielectrics
  double roughness = 0.1;  ///< m, taken as at least kLeastRoughness
  NormalDistribution distribution = NormalDistribution::beckmann;
  Masking masking = Masking::correlated;
  FresnelTerm fresnel = FresnelTerm::exact;
};
constexpr double kLeastRoughness = 1e-3;

/// Returns the reflectance of a smooth surface for unpolarised light: Fresnel's equations.
LIMN_API double fresnelReflectance(double cosine, double eta, double k);
/// Returns Schlick's approximation of it, F0 + (1 - F0) (1 - cosine)^5: off by at most 0.036 at an index of
/// 1.5, 0.26 at 5 and 0.12 for aluminium.
LIMN_API double schlickReflectance(double cosine, double eta, double k);
/// Returns one or the other for each channel.
LIMN_API glm::dvec3 reflectance(FresnelTerm term, double cosine, const glm::dvec3& eta, const glm::dvec3& k);
/// Returns D (1/sr) where sqrt(1 - n.h) is `fromNormal`; the integral of D n.h is 1 (that of the Gaussian
/// within 3e-6 up to m = 0.5, 1.8 % more at 1: its tail below the horizon counts as if it were not cut).
LIMN_API double normalDistribution(const TorranceSparrow& material, double fromNormal);
/// Returns n.w times Smith's Lambda for Gaussian slopes of width `roughness` where n.w is `cosine`: finite at
/// grazing angles, where Lambda is not.
LIMN_API double cosineLambda(double cosine, double roughness);
/// Returns G / (4 n.v), with Smith's masking for Beckmann's distribution. It is finite where n.v = 0; where
/// both cosines are 0 it is the limit along equal cosines.
LIMN_API double maskingOverCosine(const TorranceSparrow& material, double nDotL, double nDotV);

/// Returns the tables of a material. Bytes keep F D over D's largest value, and G / (pi n.v) clamped to
/// 1, as published tables of 8 bits do: at m = 0.1 and n.v = 0.2 the clamp leaves 63 % of it.
/// Throws UsageError for tables of less than 2 texels and parameters that are no numbers of a material.
LIMN_API FactoredBrdf torranceSparrowTables(const TorranceSparrow& material, int width, int height,
                                            bool warped, TableFormat format);

}  // namespace limn::brdf
