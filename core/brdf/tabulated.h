// Declares BRDFs as tables on the processor: an isotropic one over the half and difference angles, as
// measured data has it, and one over two whole directions for surfaces with a grain.
//
// Directions are unit vectors in the surface's own frame, normal = +z and tangent = +x. l points to the
// light, v to the viewer.
#pragma once

#include <cstddef>
#include <functional>
#include <glm/glm.hpp>
#include <vector>

#include "core/base/export.h"

namespace limn::brdf {

/// Returns f(l, v), 1/sr per channel.
using BrdfFunction = std::function<glm::vec3(const glm::vec3& l, const glm::vec3& v)>;

/// The half and difference angles of two directions (Rusinkiewicz 1998, A New Change of Variables for
/// Efficient BRDF Representation), without the half vector's azimuth, on which isotropic surfaces do not
/// depend.
struct HalfDifference {
  float thetaH = 0;  ///< from the normal to h = (l + v) / |l + v|, 0 to pi/2
  float thetaD = 0;  ///< from h to l, 0 to pi/2
  float phiD = 0;    ///< azimuth of l around h, from the plane of h and the normal, [0, pi): l and v may swap
};

struct DirectionPair {
  glm::vec3 l{0, 0, 1}, v{0, 0, 1};
};

/// Returns the angles of l and v, which must lie on one side of some plane (l is not -v). Where h is the
/// normal, phiD counts from the tangent.
LIMN_API HalfDifference halfDifference(const glm::vec3& l, const glm::vec3& v);

/// Returns the directions of the angles whose half vector has azimuth 0. They may lie below the horizon.
LIMN_API DirectionPair directions(const HalfDifference& angles);

/// An isotropic BRDF over the half and difference angles. Node (i, j, k) of `size` = (n, m, p) holds f at
///   thetaH = pi/2 (i/n)^2,   thetaD = pi/2 (j/m),   phiD = pi (k/p),
/// which are the indices of MERL's files. Between nodes f is trilinear in these coordinates, periodic in
/// phiD, and constant beyond the last node in the others. (The usual lookup takes the node below, the integer
/// part of the coordinates, which is half a step towards the peak.)
struct LIMN_API TabulatedBrdf {
  glm::ivec3 size{0};             ///< nodes in thetaH, thetaD and phiD
  std::vector<glm::vec3> values;  ///< 1/sr, at least 0; phiD varies fastest, thetaH slowest

  /// Returns f(l, v), 1/sr; 0 where a direction lies on or below the horizon, and of an empty table. Swapping
  /// l and v changes it by rounding alone.
  glm::vec3 evaluate(const glm::vec3& l, const glm::vec3& v) const;

  /// Returns the angles of a node.
  HalfDifference node(int i, int j, int k) const;
};

/// Returns the number of nodes of a table of this size.
std::size_t nodeCount(const glm::ivec3& size);

/// Returns `f` at the nodes of a table with at least one node a side: the mean of f(l, v) and f(v, l), which
/// is what a table of these coordinates can hold. Nodes with a direction below the horizon, or at which f is
/// negative, larger than kLargestValue or no number, are filled from their neighbours. Throws Error where no
/// node has a value.
LIMN_API TabulatedBrdf tabulate(const glm::ivec3& size, const BrdfFunction& f);

/// What loaders and tables take for the value of a BRDF at most, 1/sr.
constexpr float kLargestValue = 1e10f;

/// Replaces the nodes that have a negative channel by the mean of those neighbours along the axes that have
/// none, and so on outwards from these. Returns false, and changes nothing, where all nodes are negative.
LIMN_API bool fillInvalid(TabulatedBrdf& table);

/// A BRDF over two directions, each on a square of size x size texels: the hemisphere is projected from the
/// lower pole, p = d.xy / (1 + d.z), and the disc of p stretched along rays from its centre, s = p |p| /
/// max(|p.x|, |p.y|) in [-1, 1]^2. Texel i stands at s = (2 i + 1) / size - 1. Between texels f is linear in
/// the four coordinates, and constant from the outermost to the edge, which is the horizon.
struct LIMN_API AnisotropicTable {
  int size = 0;                   ///< texels along each side of each square
  std::vector<glm::vec3> values;  ///< 1/sr; l.x varies fastest, then l.y, v.x, v.y

  /// Returns f(l, v), 1/sr; 0 where a direction lies on or below the horizon, and of an empty table.
  glm::vec3 evaluate(const glm::vec3& l, const glm::vec3& v) const;

  /// Returns the direction at which texel (x, y) stands, above the horizon.
  glm::vec3 texelDirection(int x, int y) const;
};

/// Returns `f` at the texels of a table of at least one texel a side.
LIMN_API AnisotropicTable tabulateAnisotropic(int size, const BrdfFunction& f);

/// Returns the same of the mean of f(l, v) and f(v, l), or of one of them where the other is negative, larger
/// than kLargestValue or no number. Throws Error where both are.
LIMN_API AnisotropicTable tabulateReciprocal(int size, const BrdfFunction& f);

/// Returns the directional albedo of a BRDF per channel, the share of the light from v that it reflects: the
/// integral of f(l, v) cos(l) over l, by steps x steps midpoints over the half vectors, whose polar angle
/// grows with the square of the step as highlights are narrow. 0 where v lies on or below the horizon. The
/// cosine is applied here; albedoOfResponse() takes functions that have it.
LIMN_API glm::dvec3 albedoOfBrdf(const BrdfFunction& f, const glm::vec3& v, int steps = 128);

}  // namespace limn::brdf
