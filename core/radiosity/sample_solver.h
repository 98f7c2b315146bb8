// Declares the solution of glossy global illumination by illumination samples (Stamminger, Scheel, Granier,
// Perez-Cazorla, Drettakis and Sillion 1999, Efficient Glossy Global Illumination with Interactive Viewing):
// links between surface elements leave point samples of incident light at their receivers, and a leaf
// reflects all of them once.
#pragma once

#include <atomic>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/base/export.h"
#include "core/radiosity/direction_caps.h"
#include "core/radiosity/forest.h"
#include "core/radiosity/occlusion.h"
#include "core/radiosity/scene_elements.h"
#include "core/radiosity/surfels.h"
#include "core/radiosity/tree_builder.h"
#include "glsl/indirect/sample_reflection.glsl"
#include "glsl/numeric/geometry.glsl"

namespace limn::radiosity {

struct SampleSettings {
  /// Defaults as decimal numbers, which is how parameters show them.
  static constexpr double kLinkError = 0.003, kWiden = 0.22;
  static constexpr int kMillionPairs = 1000;

  /// Links are refined while what they transport varies by more than this part of the mean irradiance of the
  /// lights; more than 0.
  float linkError = static_cast<float>(kLinkError);
  /// As glsl::widened_alpha() has it.
  float widen = static_cast<float>(kWiden);
  /// Whether links into narrow lobes are refined further: by their size in units of the lobe's, and by a
  /// smaller error.
  bool receiver = true;
  /// How the light that glossy elements send is resolved by directions.
  TreeSettings tree = {};
  /// Whether each sample is reflected by itself and pushed into the tree of every leaf below at once, as
  /// Sillion, Drettakis and Soler 1995 do, instead of all samples of a leaf together.
  bool immediate = false;
  /// Bytes that samples may take, and trees, and the light of lights by directions; more throw UsageError.
  uint64_t memory = uint64_t{1} << 30;
  /// Pairs of elements that all rounds since begin() may look at, about a microsecond of one core each; more
  /// throw UsageError.
  uint64_t pairs = uint64_t{kMillionPairs} * 1'000'000;
};

/// Holds a sample that a link left at its receiver: the sender as a small area light.
struct SampleAtElement {
  uint32_t sender = 0;    ///< slot in the forest
  glm::vec3 radiance{0};  ///< mean over the link, what is hidden taken off, W/(sr m^2)
};

/// Holds the area light that stands for an element: a rectangle that lies as it does, in the space of the
/// elements.
struct Sender {
  glm::vec3 position{0};  ///< of the middle
  glm::vec3 normal{0};    ///< unit, to where it shines
  glm::vec3 side{0};      ///< one side: the other is at right angles to it and the normal, as `area` says
  float area = 0;
};

/// Counts what a round of shooting took.
struct ShootCounts {
  uint64_t pairs = 0;  ///< of elements that were looked at
  uint64_t links = 0;  ///< of them that left a sample
  uint64_t rays = 0;   ///< traced
};

/// Solves for the light in a scene of surface elements, a round for each bounce: reflect(), then shoot().
/// Uses all cores; the result does not depend on their number.
class LIMN_API SampleSolver {
 public:
  /// Holds references to everything but `settings`; materials are per leaf slot.
  SampleSolver(const Surfels& surfels, const Forest& forest, const ElementSpace& space,
               std::span<const LeafMaterial> materials, const SampleSettings& settings);

  /// Begins again, after elements moved or lights changed.
  void begin();
  /// Sets the light of lights at a leaf: its irradiance, W/m^2, and the same by directions, of which only
  /// leaves that are glossy() want any, in the space of the elements. Leaves may be lit by many threads at
  /// once. Throws UsageError beyond the memory allowed.
  void light(uint32_t leaf, const glm::vec3& irradiance, std::span<const glsl::IncidentLight> incident);
  /// Turns the light that arrived at leaves since the last call into light that has yet to be sent, and
  /// carries it up to the elements above.
  void reflect();
  /// Sends that light: links elements, each to the coarsest that the error allows, and leaves samples at
  /// receivers and their light at leaves. Throws UsageError beyond the pairs or the memory allowed.
  ShootCounts shoot(const Occlusion& occlusion);

  /// Returns whether a leaf has a specular part.
  bool glossy(uint32_t leaf) const { return !glsl::brdf_is_lambertian(brdf(leaf)); }
  const glsl::SurfaceBrdf& brdf(uint32_t leaf) const { return materials_[leaf].brdf; }
  /// Returns how far above a leaf's position rays begin, in the units of the elements: in hollows, positions
  /// lie behind the triangles.
  float clearance(uint32_t leaf) const { return elements_[leaf].lift + rayClearance(space_); }
  /// Returns the irradiance of each leaf slot by all rounds of shooting, W/m^2.
  std::span<const glm::vec3> irradiance() const { return irradiance_; }
  /// Returns the samples that all rounds left at an element; a leaf has those of all elements above it, too.
  std::span<const SampleAtElement> samples(uint32_t slot) const { return samples_[slot]; }
  /// Returns what stands for an element as the sender of a sample.
  Sender sender(uint32_t slot) const;
  uint64_t sampleCount() const { return sampleCount_; }
  /// Returns the most samples that the elements around a point of a glossy surface have: its triangle's
  /// leaves and all elements above them, each once.
  uint64_t mostSamplesAround() const;
  /// Returns the radiance that a leaf has yet to send towards a direction (unit, in the space of the
  /// elements), W/(sr m^2).
  glm::vec3 unshot(uint32_t leaf, const glm::vec3& direction) const;

  /// Makes the trees of the light that all rounds' samples leave leaves with, for the viewer.
  void project(const TreeSettings& settings);
  /// Returns these trees, which glossy leaves have alone, and none without light. Their frame is
  /// glsl::frame_around() of the normal in world space.
  std::span<const DirectionalTree> shown() const { return shown_; }

  /// Returns the cells of all unshot trees, and how often a lobe was evaluated since begin().
  uint64_t cellCount() const;
  uint64_t evaluations() const { return evaluations_; }

 private:
  class Shooting;
  struct Worker;
  /// Holds a triangle beside an element's vertex: its other corners, as surfels.
  struct Fan {
    uint32_t second, third;
    float area;  ///< of all fans of the element up to this one
  };
  struct Element {
    glm::vec3 position, normal;
    float area = 0;
    float reach = 0;      ///< radius of a ball around the position that holds all of the element
    float spread = 0;     ///< at most the length of (normal of a leaf - normal)
    float alpha = 1;      ///< the narrowest lobe of its leaves
    float tolerance = 1;  ///< the least part of the error allowed that its leaves' lobes allow
    bool glossy = false;  ///< one of its leaves is
    uint32_t firstChild = glsl::no_link, childCount = 0;
    uint32_t surfel = glsl::no_link;  ///< of a leaf
    float lift =
        0;  ///< of a leaf: how far above its position all triangles around its vertex are left behind
  };

  void measure();
  /// Returns the long side of a rectangle of a leaf's area whose second moments are about those of the leaf's
  /// third of the triangles around its vertex.
  glm::vec3 longSide(uint32_t leaf) const;
  void gather(uint32_t leaf);
  /// Calls `visit` with all samples of a leaf, from that of each element on that `first` says.
  template <class First, class Visit>
  void visitSamples(uint32_t leaf, const First& first, const Visit& visit) const;
  void collect(uint32_t leaf, bool freshOnly, std::vector<glsl::IncidentLight>& lights) const;
  /// Makes a leaf's tree of the worker's lights; `diffuse` is radiance that leaves beside it.
  void reflect(Worker& worker, uint32_t leaf, const glm::vec3& diffuse, const TreeSettings& settings,
               DirectionalTree& tree);
  void count(const DirectionalTree& tree);
  void pullTree(Worker& worker, uint32_t slot);
  glm::vec3 treeValue(uint32_t slot, uint32_t leaf, const glm::vec3& direction) const;
  /// Returns whether one tree stands for all that a slot sends.
  bool flat(uint32_t slot) const;

  const Surfels& surfels_;
  const Forest& forest_;
  const ElementSpace& space_;
  SampleSettings settings_;
  std::span<const LeafMaterial> materials_;  ///< of leaf slots
  std::vector<Element> elements_;            ///< of slots
  std::vector<uint32_t> firstFan_;           ///< of surfels, and the end
  std::vector<Fan> fans_;

  std::vector<glsl::Frame> frames_;  ///< of the trees of slots: that of the normal in world space

  std::vector<glm::vec3> fresh_;  ///< irradiance of leaves that reflect() has yet to see
  std::vector<std::vector<glsl::IncidentLight>> lights_;  ///< of lights, the same by directions, local
  std::vector<glm::vec3> unshot_;       ///< diffuse radiance of slots that shoot() has yet to send
  std::vector<DirectionalTree> trees_;  ///< specular radiance of slots that shoot() has yet to send
  std::vector<float> most_;             ///< the most diffuse radiance of a slot's leaves, largest channel
  std::vector<DirectionCaps> caps_;     ///< the most specular radiance of a slot's leaves
  std::vector<DirectionalTree> shown_;  ///< specular radiance of leaves by all samples
  std::vector<glm::vec3> irradiance_;
  std::vector<std::vector<SampleAtElement>> samples_;
  std::vector<uint32_t> firstFresh_;  ///< of samples_: where the last round's begin
  std::atomic<uint64_t> lightBytes_{0}, treeBytes_{0};
  uint64_t sampleCount_ = 0, evaluations_ = 0, pairCount_ = 0;
  float reference_ = 0;  ///< mean irradiance of the lights, largest channel
};

}  // namespace limn::radiosity
