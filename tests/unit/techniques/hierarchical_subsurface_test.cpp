// The walk over clusters of points against the sum over all points, and that sum against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "core/radiosity/forest.h"
#include "core/radiosity/surfels.h"
#include "techniques/hierarchical_subsurface/scatter_tree.glsl"
#include "techniques/hierarchical_subsurface/walk_tree.h"

namespace limn::glsl {
namespace {
// What shaders have as storage blocks.
std::vector<ScatterNode> nodes;
std::vector<vec4> entering_light;
}  // namespace
}  // namespace limn::glsl

#define NORMALISED 0
#include "techniques/hierarchical_subsurface/tree_walk.glsl"

namespace limn::hierarchical_subsurface {
namespace {

using glsl::ProfileColours;
using glsl::ScatterBody;

radiosity::TriangleMesh grid(int side, const std::function<glm::vec3(glm::vec2)>& place,
                             const std::function<glm::vec3(glm::vec2)>& normal) {
  radiosity::TriangleMesh mesh;
  for (int y = 0; y <= side; ++y)
    for (int x = 0; x <= side; ++x) {
      const glm::vec2 uv(static_cast<float>(x) / static_cast<float>(side),
                         static_cast<float>(y) / static_cast<float>(side));
      mesh.positions.push_back(place(uv));
      mesh.normals.push_back(normal(uv));
    }
  const auto row = static_cast<uint32_t>(side + 1);
  for (uint32_t y = 0; y + 1 < row; ++y)
    for (uint32_t x = 0; x + 1 < row; ++x) {
      const uint32_t a = y * row + x;
      for (const uint32_t k : {a, a + 1, a + row, a + 1, a + row + 1, a + row}) mesh.indices.push_back(k);
    }
  return mesh;
}

/// The square [-1, 1]^2 in the plane z = 0.
radiosity::TriangleMesh square(int side) {
  return grid(
      side, [](glm::vec2 uv) { return glm::vec3(2.f * uv - 1.f, 0); },
      [](glm::vec2) { return glm::vec3(0, 0, 1); });
}

/// A band on the x axis, 50 times as long as wide.
radiosity::TriangleMesh band(int side) {
  return grid(
      side, [](glm::vec2 uv) { return glm::vec3(2.f * uv.x - 1.f, 0.04f * uv.y - 0.02f, 0); },
      [](glm::vec2) { return glm::vec3(0, 0, 1); });
}

/// A small square whose middle is there.
radiosity::TriangleMesh patch(const glm::vec3& middle) {
  return grid(
      2, [middle](glm::vec2 uv) { return middle + glm::vec3(0.04f * uv - 0.02f, 0); },
      [](glm::vec2) { return glm::vec3(0, 0, 1); });
}

/// The unit sphere, as a cube whose faces are blown up.
std::vector<radiosity::TriangleMesh> sphere(int side) {
  std::vector<radiosity::TriangleMesh> faces;
  for (int face = 0; face < 6; ++face) {
    const auto place = [face](glm::vec2 uv) {
      const glm::vec2 angle = (2.f * uv - 1.f) * 0.78539816f;
      const glm::vec3 p(std::tan(angle.x), std::tan(angle.y), 1);
      const glm::vec3 turned = face % 3 == 0   ? p
                               : face % 3 == 1 ? glm::vec3(p.y, p.z, p.x)
                                               : glm::vec3(p.z, p.x, p.y);
      return glm::normalize(face < 3 ? turned : -turned);
    };
    faces.push_back(grid(side, place, place));
    if (face >= 3)
      for (size_t t = 0; t < faces.back().indices.size(); t += 3)
        std::swap(faces.back().indices[t], faces.back().indices[t + 1]);
  }
  return faces;
}

/// One body of one or several meshes.
radiosity::TriangleMesh joined(const std::vector<radiosity::TriangleMesh>& parts) {
  radiosity::TriangleMesh whole;
  for (const radiosity::TriangleMesh& part : parts) {
    const auto first = static_cast<uint32_t>(whole.positions.size());
    whole.positions.insert(whole.positions.end(), part.positions.begin(), part.positions.end());
    whole.normals.insert(whole.normals.end(), part.normals.begin(), part.normals.end());
    for (const uint32_t i : part.indices) whole.indices.push_back(first + i);
  }
  return whole;
}

class HierarchicalSubsurface : public ::testing::Test {
 protected:
  /// Makes the nodes of some bodies, whose softening is as BodyPoints has it.
  void build(const std::vector<radiosity::TriangleMesh>& bodies) {
    for (const radiosity::TriangleMesh& body : bodies) {
      surfels_.push_back(radiosity::createSurfels({&body, 1}, 10));
      forests_.emplace_back(surfels_.back());
    }
    std::vector<const radiosity::Forest*> forests;
    for (const radiosity::Forest& forest : forests_) forests.push_back(&forest);
    tree_ = WalkTree(forests);
    for (size_t body = 0; body < bodies.size(); ++body) {
      const radiosity::Surfels& surfels = surfels_[body];
      std::vector<float> areas(forests_[body].leafSlots(), 0);
      float area = 0, squares = 0;
      for (size_t i = 0; i < surfels.size(); ++i) {
        areas[forests_[body].leafOf()[i]] = surfels.areas[i];
        area += surfels.areas[i];
        squares += surfels.areas[i] * surfels.areas[i];
      }
      tree_.place(body, forests_[body], radiosity::ElementSpace(), areas);
      softening_.push_back(std::sqrt(squares / area));
    }
    glsl::nodes.assign(tree_.nodes().begin(), tree_.nodes().end());
    // Elements are turned against the world: the space of this test is the world.
    const radiosity::ElementSpace space;
    for (glsl::ScatterNode& n : glsl::nodes) n.centre = space.direction(n.centre);
  }

  /// Lights the leaves and sums level by level, as sum_clusters.comp.glsl does.
  template <class Light>
  void light(const Light& at) {
    glsl::entering_light.assign(glsl::nodes.size(), glm::vec4(0));
    for (const auto& level : tree_.levels())
      for (uint32_t i = level.first; i < level.first + level.count; ++i) {
        const glsl::ScatterNode& n = glsl::nodes[i];
        if (level.first == 0) {
          glsl::entering_light[i] = glm::vec4(at(n.centre), 0);
          continue;
        }
        glm::vec4 sum(0);
        for (uint32_t k = 0; k < n.child_count; ++k)
          sum += glsl::nodes[n.children + k].area * glsl::entering_light[n.children + k];
        if (n.area > 0) glsl::entering_light[i] = sum / n.area;
      }
  }

  /// All points of the first body, one by one.
  glm::vec3 directSum(const glm::vec3& x, const ProfileColours& matter) const {
    glm::dvec3 sum(0);
    for (uint32_t i = 0; i < tree_.leafCount(); ++i) {
      const glsl::ScatterNode& n = glsl::nodes[i];
      const glm::vec3 way = n.centre - x;
      const float r = std::sqrt(glm::dot(way, way) + softening_[0] * softening_[0]);
      sum += glm::dvec3(n.area * glm::vec3(glsl::entering_light[i]) * glsl::scatter_far(matter, r));
    }
    return glm::vec3(sum);
  }

  glm::vec3 walk(size_t body, const glm::vec3& x, const ProfileColours& matter, float tolerance) const {
    return glsl::light_of_points(tree_.first(body), x, matter, softening_[body], tolerance);
  }

  std::vector<radiosity::Surfels> surfels_;
  std::vector<radiosity::Forest> forests_;
  std::vector<float> softening_;
  WalkTree tree_;
};

/// extinction: per radius.
ScatterBody bodyOf(const glm::vec3& extinction, const glm::vec3& absorption, float eta = 1.3f) {
  return {.centre = glm::vec3(0),
          .radius = 1,
          .extinction = extinction,
          .softening = 0,
          .absorption = absorption,
          .eta = eta,
          .first_node = 0,
          .textured = 0,
          .unused = glm::uvec2(0)};
}
ProfileColours matterOf(const ScatterBody& body) {
  return glsl::scatter_matter(body, glsl::diffusion_boundary(body.eta), glm::vec3(1));
}

glm::vec3 stripes(const glm::vec3& p) {
  return {1.f + std::sin(9.f * p.x), p.y > 0.1f ? 1.f : 0.f, 0.5f};
}

TEST_F(HierarchicalSubsurface, WalkMeetsEachPointOfItsBodyOnce) {
  build({joined(sphere(9)), square(13), joined(sphere(2))});
  for (size_t body = 0; body < 3; ++body) {
    std::vector<int> met(glsl::nodes.size(), 0);
    uint32_t leaves = 0;
    for (uint32_t at = tree_.first(body); at != glsl::scatter_none;) {
      const glsl::ScatterNode& n = glsl::nodes[at];
      ASSERT_EQ(met[at]++, 0);
      const bool leaf = n.children == glsl::scatter_none;
      if (leaf) {
        ++leaves;
        EXPECT_LT(at, tree_.leafCount());
        EXPECT_GT(n.area, 0);
      }
      at = leaf ? n.next : n.children;
    }
    EXPECT_EQ(leaves, surfels_[body].size());
  }
}

TEST_F(HierarchicalSubsurface, ClustersHoldTheAreaAndCentroidOfTheirPoints) {
  build({joined(sphere(9))});
  float area = 0;
  for (uint32_t at = tree_.first(0); at != glsl::scatter_none; at = glsl::nodes[at].next)
    area += glsl::nodes[at].area;
  EXPECT_NEAR(area, 4 * glsl::pi, 0.02f * 4 * glsl::pi);  // chords of 10 degrees: 1 - cos(5 degrees) and less
  for (const glsl::ScatterNode& n : glsl::nodes) {
    if (n.child_count == 0) continue;
    glm::vec3 centre(0);
    float sum = 0;
    for (uint32_t k = 0; k < n.child_count; ++k) {
      sum += glsl::nodes[n.children + k].area;
      centre += glsl::nodes[n.children + k].area * glsl::nodes[n.children + k].centre;
    }
    EXPECT_NEAR(n.area, sum, 1e-5f * sum);
    EXPECT_LT(glm::length(n.centre - centre / sum), 1e-5f);
  }
}

// Of a body that moves as a whole nobody asks again where its points are among themselves.
TEST_F(HierarchicalSubsurface, NodesMoveWithTheirBody) {
  build({joined(sphere(5)), square(3)});
  const std::vector<glsl::ScatterNode> before(tree_.nodes().begin(), tree_.nodes().end());
  const BodyMotion motion{.turn = glm::mat3(0, 1.2f, 0, -0.9f, 0, 0.1f, 0, 0, 1), .shift = {3, -2, 0.5f}};
  std::vector<float> areas(forests_[1].leafSlots(), 0);
  for (size_t i = 0; i < surfels_[1].size(); ++i) areas[forests_[1].leafOf()[i]] = surfels_[1].areas[i];
  tree_.place(1, forests_[1], radiosity::ElementSpace(), areas, motion);
  std::vector<bool> moved(before.size(), false);
  for (uint32_t at = tree_.first(1); at != glsl::scatter_none;) {
    moved[at] = true;
    at = before[at].children != glsl::scatter_none ? before[at].children : before[at].next;
  }
  for (size_t i = 0; i < before.size(); ++i) {
    const glsl::ScatterNode &was = before[i], &is = tree_.nodes()[i];
    EXPECT_EQ(is.area, was.area);
    const glm::vec3 expected = moved[i] ? motion.turn * was.centre + motion.shift : was.centre;
    EXPECT_LT(glm::length(is.centre - expected), 1e-6f);
  }
}

// A cluster of area A that looks as large as the tolerance t from distance s = sqrt(A / t) has points within
// sqrt(A / 2) of its centroid, with a mean square of A / 12 along each of two axes. The profile falls at most
// as s^-3 where it is not exponential, so that the second order is at most 12 / (2 s^2) A / 12 = t / 2 of it;
// the variation of light over the cluster is of the same order.
TEST_F(HierarchicalSubsurface, ClustersMeetTheSumOverAllPointsWithinTheTolerance) {
  build({joined(sphere(48))});
  light(stripes);
  for (const float extinction : {0.3f, 3.f, 10.f, 40.f})
    for (const float absorption : {0.f, 0.01f, 0.3f}) {
      const ProfileColours matter =
          matterOf(bodyOf(glm::vec3(extinction) * glm::vec3(1, 2, 3), glm::vec3(absorption)));
      for (const float tolerance : {0.01f, 0.1f, 1.f})
        for (int i = 0; i < 40; ++i) {
          const float z = 1.f - 2.f * (static_cast<float>(i) + 0.5f) / 40.f,
                      angle = 2.4f * static_cast<float>(i);
          const float ring = std::sqrt(1.f - z * z);
          const glm::vec3 x(ring * std::cos(angle), ring * std::sin(angle), z);
          const glm::vec3 all = directSum(x, matter), some = walk(0, x, matter, tolerance);
          // In the shadow what is wrong is a part of what would arrive at full light.
          const glm::vec3 full = directSum(x, matter) + 0.2f;
          for (int c = 0; c < 3; ++c) EXPECT_NEAR(some[c], all[c], tolerance * 0.5f * full[c]);
        }
    }
}

// By its area the whole band looks small from its end. A cluster that is not opened counts as t s^2 at most.
// If it counts as 2 r^2, its points have a mean square of r^2 / 3 along the band, where they lie evenly, and
// the second order, 12 / (2 s^2) times that, is at most t. If it counts as its area A, r^2 is A at most, the
// mean square A / 3, and the second order 2 t.
TEST_F(HierarchicalSubsurface, LongClustersMeetTheSumOverAllPointsWithinTheTolerance) {
  build({band(64)});
  light([](const glm::vec3&) { return glm::vec3(1); });
  const ProfileColours matter = matterOf(bodyOf({3, 10, 30}, glm::vec3(0.001f)));
  for (const glm::vec3& x : {glm::vec3(1, 0, 0), glm::vec3(1.02f, 0, -0.01f), glm::vec3(0.6f, 0.02f, 0)}) {
    const glm::vec3 all = directSum(x, matter);
    for (const float tolerance : {0.03f, 0.1f}) {
      const glm::vec3 some = walk(0, x, matter, tolerance);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(some[c], all[c], 2 * tolerance * all[c]) << x.x << ' ' << c;
    }
  }
}

// Pieces of a few points share a cluster, wherever they lie. What a piece gets of the seven others is less
// than a hundredth of its own light.
TEST_F(HierarchicalSubsurface, ScatteredPiecesGetTheirOwnLight) {
  std::vector<radiosity::TriangleMesh> pieces;
  for (int i = 0; i < 8; ++i) {
    const float angle = glsl::pi / 4 * static_cast<float>(i);
    pieces.push_back(patch({std::cos(angle), std::sin(angle), 0}));
  }
  build({joined(pieces)});
  light([](const glm::vec3&) { return glm::vec3(1); });
  const ProfileColours matter = matterOf(bodyOf(glm::vec3(30), glm::vec3(0.001f)));
  for (const glm::vec3& x : {glm::vec3(1, 0, 0), glm::vec3(0, -1, 0)}) {
    const float all = directSum(x, matter).x;
    for (const float tolerance : {0.03f, 0.1f})
      EXPECT_NEAR(walk(0, x, matter, tolerance).x, all, 0.02f * all) << tolerance;
  }
}

// Of a sphere's area, pi d^2 lies within the chord d, as in the plane: all that enters alike at a sphere of
// radius R leaves as C times the share within 2 R.
TEST_F(HierarchicalSubsurface, UniformLightOnASphereMeetsTheClosedForm) {
  build({joined(sphere(48))});
  light([](const glm::vec3&) { return glm::vec3(1); });
  for (const float extinction : {0.1f, 1.f, 5.f, 30.f, 200.f, 1e4f}) {
    const ScatterBody body = bodyOf(glm::vec3(extinction), {0, 0.01f, 0.3f});
    const ProfileColours matter = matterOf(body);
    const glsl::DiffusionBoundary boundary = glsl::diffusion_boundary(body.eta);
    for (const glm::vec3& x :
         {glm::vec3(0, 0, 1), glm::normalize(glm::vec3(1, 2, -3)), glm::vec3(-0.6f, 0.8f, 0)}) {
      const glm::vec3 leaving = glsl::scatter_near(matter, softening_[0]) + walk(0, x, matter, 0.1f);
      for (int c = 0; c < 3; ++c) {
        const glsl::DiffusionDipole dipole = glsl::diffusion_dipole(body.absorption[c], boundary);
        const float expected = dipole.reflectance * glsl::diffusion_dipole_share(dipole, 2 * extinction);
        EXPECT_NEAR(leaving[c], expected, 0.02f * expected) << extinction << " " << c;
      }
    }
  }
}

TEST_F(HierarchicalSubsurface, UniformLightOnAPlaneLeavesAsTheReflectance) {
  build({square(96)});
  light([](const glm::vec3&) { return glm::vec3(1); });
  // Without absorption profiles reach far: of 1e3 mean free paths 0.998.
  for (const float extinction : {30.f, 100.f, 300.f, 1e4f, 1e9f}) {
    const ScatterBody body = bodyOf(glm::vec3(extinction), {0.3f, 0.03f, 0.01f});
    const ProfileColours matter = matterOf(body);
    for (const glm::vec3& x : {glm::vec3(0), glm::vec3(0.013f, -0.006f, 0), glm::vec3(0.1f, 0.11f, 0)}) {
      const glm::vec3 leaving = glsl::scatter_near(matter, softening_[0]) + walk(0, x, matter, 0.1f);
      for (int c = 0; c < 3; ++c) {
        const float expected =
            glsl::diffusion_dipole(body.absorption[c], glsl::diffusion_boundary(body.eta)).reflectance;
        EXPECT_NEAR(leaving[c], expected, 0.02f * expected) << extinction << " " << c;
      }
    }
  }
}

// Where mean free paths are far shorter than the way between points, light leaves where it enters.
TEST_F(HierarchicalSubsurface, ShortPathsMeetTheLocalLimit) {
  build({square(32)});
  light(stripes);
  const ScatterBody body = bodyOf(glm::vec3(1e5f), {0, 0.01f, 0.3f});
  const ProfileColours matter = matterOf(body);
  const glm::vec3 far = walk(0, {0.2f, 0.1f, 0}, matter, 0.1f),
                  near = glsl::scatter_near(matter, softening_[0]);
  for (int c = 0; c < 3; ++c) {
    const float local =
        glsl::diffusion_dipole(body.absorption[c], glsl::diffusion_boundary(body.eta)).reflectance;
    EXPECT_NEAR(near[c], local, 1e-3f);
    EXPECT_LT(far[c], 1e-3f);
  }
}

TEST_F(HierarchicalSubsurface, ExtremesAreFiniteAndMakeNoLight) {
  build({joined(sphere(16))});
  light([](const glm::vec3&) { return glm::vec3(1); });
  for (const float eta : {1.f, 1.3f, 3.f})
    for (const float extinction : {1e-10f, 1e-6f, 1.f, 1e6f, 1e9f, 1e13f}) {
      const ProfileColours matter = matterOf(bodyOf(glm::vec3(extinction), {0, 0.5f, 1}, eta));
      for (const float softening : {softening_[0], 1e9f}) {
        const glm::vec3 near = glsl::scatter_near(matter, softening), far = walk(0, {0, 0, 1}, matter, 0.1f),
                        leaving = near + far;
        for (int c = 0; c < 3; ++c) {
          EXPECT_TRUE(std::isfinite(leaving[c])) << eta << " " << extinction;
          EXPECT_GE(near[c], 0);
          EXPECT_GE(far[c], 0);
        }
        if (softening == softening_[0]) {
          EXPECT_LE(leaving.x, 1.05f) << eta << " " << extinction;
          EXPECT_EQ(leaving.z, 0);  // nothing scatters
        }
      }
    }
}

// d/dr of what stands for all light within r is the profile's ring.
TEST_F(HierarchicalSubsurface, BothProfilesAreTheDerivativesOfTheirShares) {
  const glsl::DiffusionBoundary boundary = glsl::diffusion_boundary(1.4f);
  const glm::vec3 extinction(1, 2, 0.5f), absorption(0.05f, 0.2f, 0.01f);
  const auto check = [](const auto& colours) {
    for (int c = 0; c < 3; ++c)
      for (const float r : {0.1f, 0.5f, 1.f, 3.f}) {
        const float step = 0.01f * r, ring = 2 * glsl::pi * r * 2 * step;
        const float slope =
            (glsl::diffusion_share(colours, c, r + step) - glsl::diffusion_share(colours, c, r - step)) /
            ring;
        const float density = glsl::diffusion_density(colours, r)[c];
        EXPECT_NEAR(slope, density, 2e-3f * density) << c << ' ' << r;
      }
  };
  check(glsl::dipole_colours(extinction, absorption, boundary));
  check(glsl::normalised_colours(extinction, absorption, boundary));
}

}  // namespace
}  // namespace limn::hierarchical_subsurface
