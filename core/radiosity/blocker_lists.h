// Lists the triangles that may hide a light from the surface around an element, so that V can be found for
// pixels there, whose outlines are finer than elements and bins.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/base/export.h"
#include "core/radiosity/links.h"
#include "core/radiosity/scene_elements.h"
#include "glsl/scene/light.glsl"

namespace limn::radiosity {

/// Bounds the points of a light, in world space.
struct LightBounds {
  glm::vec3 centre{0};  ///< of a sphere, m; of a distant light: the unit vector towards it
  float radius = 0;     ///< of the sphere, m; of a distant light: the sine of half the angle it spans
  bool distant = false;
  /// Says whether it is a disc of directions whose angular diameter exceeds kWidestDisc.
  bool wideDisc = false;
  std::array<glm::vec3, 2> halves{};    ///< halves of a rectangle's sides, m; of others 0
  uint32_t object = glsl::no_instance;  ///< that the light is, which does not hide it

  /// Limits the discs of directions for which there are lists, radians. The points that lists are tested with
  /// lie evenly on the plane across the disc's axis, and not evenly in solid angle as V counts them: up to
  /// this angle that changes V by less than 0.008.
  static constexpr float kWidestDisc = 0.4f;

  LIMN_API static LightBounds of(const glsl::Light& light);
};

/// Holds, for each light and leaf, the triangles between leaves that may lie on a way from the leaf's part of
/// the surface to the light. That part is where no other leaf has a greater weight in interpolation.
class LIMN_API BlockerLists {
 public:
  /// Holds where a leaf's list lies among all.
  struct Range {
    uint32_t first = 0;
    uint32_t count = kUnlisted;
  };
  /// Stands for the number of triangles of a leaf that has no list: it is turned away from the light or in
  /// full shadow, its list would be longer than kLongest, there was no room, or the light is a wide disc.
  static constexpr uint32_t kUnlisted = ~0u;
  static constexpr uint32_t kLongest = 4096;
  /// Marks a triangle in a list that hides from both sides; of the others only the front does.
  static constexpr uint32_t kBothSides = 1u << 31;

  /// Makes the lists, which hold at most `perLight` triangles of each light: those of one do not depend on
  /// what other lights there are. Of closed and double-sided objects they have only what a way may enter,
  /// since it enters whatever it leaves. Where `links` are given, leaves without a list are also those in
  /// full shadow: all bins around the light are filled, at them and at their neighbours. Uses all cores; the
  /// result does not depend on their number. Allocates nothing once it has seen lists as long.
  void build(const SceneElements& elements, const Links* links, std::span<const LightBounds> lights,
             size_t perLight);

  /// Returns the ranges of all leaf slots, light after light.
  std::span<const Range> ranges() const { return ranges_; }
  /// Returns the lists: numbers of triangles as Forest::triangles() has them, some marked by kBothSides.
  std::span<const uint32_t> triangles() const { return triangles_; }

 private:
  struct Shaft;
  /// Holds the lists of some leaves, one after the other, and the groups that a walk still has to visit.
  struct Part {
    std::vector<uint32_t> triangles, waiting;
  };

  void bound(const SceneElements& elements);
  void measureReceivers(const SceneElements& elements);
  void findHidden(const SceneElements& elements, const Links& links, const LightBounds& light);
  void findReceivers(const SceneElements& elements, const LightBounds& light);
  void list(const SceneElements& elements, const LightBounds& light, uint32_t leaf, Part& part) const;
  /// Lists what some parts of the leaves need, and keeps it while all lists together have `most` triangles.
  void listParts(const SceneElements& elements, const LightBounds& light, uint32_t firstPart,
                 uint32_t endPart, size_t most, std::span<Range> ranges);

  /// Bounds a triangle by a sphere, and holds its plane.
  struct Triangle {
    glm::vec4 sphere;
    glm::vec3 normal;  ///< unit, or 0
    float offset;      ///< dot(normal, a point of the plane)
  };

  std::vector<Triangle> shapes_;   ///< of all triangles
  std::vector<glm::vec4> bounds_;  ///< of each slot's triangles: a sphere; radius < 0: none
  /// Holds the extent of a leaf's part of the surface around its vertex, m, and whether the light in work may
  /// need its list.
  struct Receiver {
    float reach = 0;   ///< in all directions
    float height = 0;  ///< along the leaf's normal, either way
    bool listed = false;
  };
  std::vector<Receiver> receivers_;    ///< of each leaf
  std::vector<unsigned char> hidden_;  ///< whether all bins around the light are filled, of each leaf
  std::vector<Range> ranges_;
  std::vector<uint32_t> triangles_;
  std::vector<Part> parts_;  ///< of kPart leaves each: those in work
};

}  // namespace limn::radiosity
