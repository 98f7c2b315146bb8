// Clusters of virtual point lights against k-means on the CPU.
#include "core/indirect/virtual_areas.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <random>
#include <utility>

#include "glsl/indirect/gather.glsl"
#include "glsl/shadow/shadow_view.glsl"
#include "tests/gpu/bind_by_name.h"
#include "tests/gpu/gl_test.h"
#include "tests/support/test_scenes.h"

namespace limn {
namespace {

using namespace limn::test;
using glm::vec3;
using Lights = std::vector<glsl::VirtualPointLight>;

glsl::VirtualPointLight light(vec3 position, vec3 normal, float flux = 1) {
  return {position, 1, normal, 0, {flux, flux, flux, 0}};
}

struct Clusters {
  std::vector<glsl::VirtualAreaLight> areas;
  std::vector<glsl::ShadowView> views;
  Lights sorted;
  std::vector<uint32_t> mapping;  ///< by the lights' own order
};

constexpr float kExtent = 4;  // of the scene's cube: a diagonal of 4

/// The same on the CPU, in double where it sums.
struct Reference {
  std::vector<glsl::VirtualAreaLight> areas;
  std::vector<uint32_t> mapping;

  Reference(const Lights& lights, const indirect::VirtualAreaDesc& desc) {
    const auto n = static_cast<uint32_t>(lights.size());
    const auto m = static_cast<uint32_t>(std::min<size_t>(static_cast<size_t>(desc.count), n));
    for (uint32_t k = 0; k < m; ++k) {
      areas.push_back({.position = {}, .count = -1, .normal = {}, .extent = {}, .unused = {}});
      for (uint32_t i = glsl::cluster_start(k, n, m); i < glsl::cluster_start(k + 1, n, m); ++i) {
        if (!glsl::virtual_light_shines(lights[i])) continue;
        areas[k].position = lights[i].position;
        areas[k].count = 0;
        areas[k].normal = glm::vec4(lights[i].normal, 0);
        break;
      }
    }
    for (int i = 0; i <= desc.iterations; ++i) iterate(lights, desc);
  }

  void iterate(const Lights& lights, const indirect::VirtualAreaDesc& desc) {
    mapping.assign(lights.size(), 0);
    std::vector<glm::dvec3> positions(areas.size()), normals(areas.size());
    std::vector<double> counts(areas.size());
    for (size_t i = 0; i < lights.size(); ++i) {
      float least = 3e38f;
      for (uint32_t k = 0; k < areas.size(); ++k) {
        const float d =
            glsl::cluster_distance(lights[i], areas[k], 1 / kExtent, desc.weightPosition, desc.weightAngle);
        if (areas[k].count >= 0 && d < least) least = d, mapping[i] = k;
      }
      if (!glsl::virtual_light_shines(lights[i])) continue;
      positions[mapping[i]] += glm::dvec3(lights[i].position);
      normals[mapping[i]] += glm::dvec3(lights[i].normal);
      ++counts[mapping[i]];
    }
    for (size_t k = 0; k < areas.size(); ++k) {
      const auto count = static_cast<float>(counts[k]);
      if (count > 0) {
        areas[k].position = vec3(positions[k] / counts[k]);
        areas[k].count = count;
        areas[k].normal = glm::vec4(glsl::cluster_normal(vec3(normals[k]), count), 0);
      } else if (areas[k].count >= 0) {
        areas[k].count = 0;
      }
    }
  }
};

class VirtualAreasTest : public GlTest {
 protected:
  Clusters cluster(const Lights& lights, const indirect::VirtualAreaDesc& desc) {
    scene::Scene scene;
    const float half = 0.5f * kExtent / std::sqrt(3.f);
    scene::Primitive cube;
    cube.positions = {vec3(-half), vec3(half), vec3(-half, half, half)};
    cube.normals.assign(3, {0, 1, 0});
    cube.tangents.assign(3, {1, 0, 0, 1});
    cube.uvs.assign(3, {0, 0});
    cube.indices = {0, 1, 2};
    cube.material = addMaterial(scene);
    addMesh(scene, finish(cube));
    scene::Pose pose;
    addInstance(scene, pose, 0);
    scene::GpuScene gpuScene(device(), scene);
    gpuScene.update(pose, scene::frameBounds(pose.bounds), {64, 64}, 0);
    frame::ResourcePool pool(device());
    frame::FrameGraph graph;
    const gpu::Buffer buffer = gpu::Buffer::of<glsl::VirtualPointLight>(device(), "lights", lights);
    const indirect::VirtualAreas areas = indirect::addVirtualAreas(
        graph, gpuScene, graph.importBuffer("lights", buffer), static_cast<int>(lights.size()), desc);
    graph.output(areas.areas);
    graph.output(areas.views);
    graph.output(areas.lights);
    graph.prepare(device(), shaders(), pool);
    graph.execute();
    Clusters out;
    out.areas.resize(static_cast<size_t>(areas.count));
    out.views.resize(out.areas.size());
    out.sorted.resize(lights.size());
    graph.buffer(areas.areas).read(0, out.areas.data(), out.areas.size() * sizeof(out.areas[0]));
    graph.buffer(areas.views).read(0, out.views.data(), out.views.size() * sizeof(out.views[0]));
    graph.buffer(areas.lights).read(0, out.sorted.data(), out.sorted.size() * sizeof(out.sorted[0]));
    for (const glsl::VirtualPointLight& l : lights) {
      const auto found = std::ranges::find_if(out.sorted, [&](const glsl::VirtualPointLight& s) {
        return s.position == l.position && s.normal == l.normal && s.flux == l.flux;
      });
      EXPECT_NE(found, out.sorted.end()) << "every light is among the sorted ones";
      if (found != out.sorted.end()) out.mapping.push_back(static_cast<uint32_t>(found->cluster));
    }
    gpuScene.forget();
    return out;
  }

  /// Two walls and a floor, points as irregular as those of a map.
  static Lights room(int count, uint32_t seed = 5, vec3 shift = {}) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform(-1, 1);
    Lights lights;
    for (int i = 0; i < count; ++i) {
      const float u = uniform(random), v = uniform(random);
      const float flux = i % 7 == 3 ? 0.f : 1.f;
      if (i % 3 == 0) lights.push_back(light(shift + vec3(u, -1, v), {0, 1, 0}, flux));
      if (i % 3 == 1) lights.push_back(light(shift + vec3(-1, u, v), {1, 0, 0}, flux));
      if (i % 3 == 2) lights.push_back(light(shift + vec3(u, v, -1), {0, 0, 1}, flux));
    }
    return lights;
  }

  static void expectEqual(const Clusters& gpu, const Reference& cpu) {
    ASSERT_EQ(gpu.areas.size(), cpu.areas.size());
    EXPECT_EQ(gpu.mapping, cpu.mapping);
    for (size_t k = 0; k < cpu.areas.size(); ++k) {
      EXPECT_LT(glm::length(gpu.areas[k].position - cpu.areas[k].position), 1e-5f) << k;
      EXPECT_NEAR(gpu.areas[k].count, cpu.areas[k].count, 1e-5f) << k;
      EXPECT_LT(glm::length(gpu.areas[k].normal - cpu.areas[k].normal), 1e-5f) << k;
    }
  }
};

TEST_F(VirtualAreasTest, AgreeWithTheProcessor) {
  const Lights lights = room(1000);  // divisible by few numbers of clusters
  for (const int count : {1, 2, 7, 30, 64, 1000}) {
    for (const int iterations : {0, 1, 5}) {
      SCOPED_TRACE(testing::Message() << count << " clusters, " << iterations << " iterations");
      const indirect::VirtualAreaDesc desc{.count = count, .iterations = iterations};
      expectEqual(cluster(lights, desc), Reference(lights, desc));
    }
  }
}

TEST_F(VirtualAreasTest, AreasHoldTheirLights) {
  const Lights lights = room(600);
  const Clusters c = cluster(lights, {.count = 12, .iterations = 6, .near = 0.02f, .mapSize = 128});
  float counted = 0;
  for (size_t k = 0; k < c.areas.size(); ++k) {
    counted += c.areas[k].count;
    const glsl::ShadowView& view = c.views[k];
    EXPECT_EQ(view.projection, glsl::shadow_paraboloid);
    EXPECT_EQ(view.layer, k);
    EXPECT_EQ(view.size, 128u);
    EXPECT_EQ(view.light, glsl::no_light);
    EXPECT_NEAR(view.near, 0.02f * kExtent, 1e-5f);
    EXPECT_EQ(view.origin, c.areas[k].position);
    glm::vec2 low(1e30f), high(-1e30f);
    for (size_t i = 0; i < lights.size(); ++i) {
      if (c.mapping[i] != k || !glsl::virtual_light_shines(lights[i])) continue;
      const vec3 local = glsl::shadow_local(view, vec3(lights[i].position));
      low = glm::min(low, glm::vec2(local));
      high = glm::max(high, glm::vec2(local));
    }
    const float n = c.areas[k].count;
    EXPECT_NEAR(c.areas[k].extent.x, (high.x - low.x) * (n + 1) / (n - 1), 1e-4f);
    EXPECT_NEAR(c.areas[k].extent.y, (high.y - low.y) * (n + 1) / (n - 1), 1e-4f);
  }
  EXPECT_EQ(counted, std::ranges::count_if(lights, glsl::virtual_light_shines));
}

TEST_F(VirtualAreasTest, OfASinglePlaneAndOfOneLightEach) {
  Lights plane = room(300);
  for (auto& l : plane) {
    l.position.y = 0.25f;
    l.normal = {0, 1, 0};
  }
  const Clusters few = cluster(plane, {.count = 9});
  for (const auto& area : few.areas) {
    EXPECT_NEAR(area.position.y, 0.25f, 1e-6f);
    EXPECT_EQ(vec3(area.normal), vec3(0, 1, 0));
    EXPECT_GT(area.extent.x * area.extent.y, 0);
  }
  const Clusters each = cluster(plane, {.count = 500});  // more than lights: as many as lights
  ASSERT_EQ(each.areas.size(), 300u);
  for (const auto& area : each.areas) EXPECT_EQ(area.extent, glm::vec2(0));
}

TEST_F(VirtualAreasTest, NothingToClusterDoesNoHarm) {
  Lights dark = room(100);
  for (auto& l : dark) l.flux = {};
  for (const auto& area : cluster(dark, {.count = 8}).areas) EXPECT_EQ(area.count, -1);
  // All in one place, with normals that cancel out.
  Lights same;
  for (int i = 0; i < 64; ++i) same.push_back(light(vec3(0.5f), {0, 0, i % 2 ? 1.f : -1.f}));
  const Clusters one = cluster(same, {.count = 1});
  EXPECT_EQ(vec3(one.areas[0].normal), vec3(0));
  EXPECT_NEAR(glm::length(one.views[0].axis_z), 1, 1e-6f);
  const Clusters many = cluster(same, {.count = 8});
  float counted = 0;
  for (const auto& area : many.areas) {
    EXPECT_FALSE(glm::any(glm::isnan(area.position)) || glm::any(glm::isnan(area.normal)) ||
                 glm::any(glm::isnan(area.extent)));
    EXPECT_LT(glm::length(area.position - (area.count >= 0 ? vec3(0.5f) : vec3(0))), 1e-6f);
    counted += std::max(area.count, 0.f);
  }
  EXPECT_EQ(counted, 64);
}

/// Everything lies behind their views, where triangles end before they are rasterised.
TEST_F(VirtualAreasTest, EmptyClustersLookOutOfTheScene) {
  Lights dark = room(100);
  for (auto& l : dark) l.flux = {};
  const Lights same(64, light(vec3(0.5f), {0, 0, 1}));  // the first cluster has all of them
  for (const auto& [lights, empty] : {std::pair(dark, 8), std::pair(same, 7)}) {
    const Clusters c = cluster(lights, {.count = 8});
    int found = 0;
    for (size_t k = 0; k < c.areas.size(); ++k) {
      if (c.areas[k].count > 0) continue;
      ++found;
      for (int corner = 0; corner < 8; ++corner) {
        const vec3 side(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
        EXPECT_LT(glsl::shadow_local(c.views[k], 0.5f * kExtent / std::sqrt(3.f) * side).z, 0) << k;
      }
    }
    EXPECT_EQ(found, empty);
  }
}

TEST_F(VirtualAreasTest, SortedByClusterWithinEachSubBuffer) {
  const Lights lights = room(500);
  constexpr uint32_t block = 4;
  const Clusters c = cluster(lights, {.count = 20, .block = block});
  for (uint32_t s = 0; s < block * block; ++s) {
    const uint32_t first = glsl::gather_begin(s, 500, block), end = glsl::gather_begin(s + 1, 500, block);
    for (uint32_t i = first; i < end; ++i) {
      if (i > first) {
        EXPECT_LE(c.sorted[i - 1].cluster, c.sorted[i].cluster);
      }
      const auto found = std::ranges::find_if(
          lights, [&](const glsl::VirtualPointLight& l) { return l.position == c.sorted[i].position; });
      const auto index = static_cast<uint32_t>(found - lights.begin());
      EXPECT_TRUE(index >= first && index < end) << "lights stay in their sub-buffer";
    }
  }
}

/// The first lights of as many as there may be: only the last one is of a cluster before theirs.
TEST_F(VirtualAreasTest, SortsAsManyLightsAsThereMayBe) {
  constexpr uint32_t count = 65536, group = 64;
  Lights lights(count);
  for (uint32_t i = 0; i < count; ++i) lights[i].flux.x = static_cast<float>(i);
  std::vector<uint32_t> mapping(count, 1);
  mapping.back() = 0;
  const gpu::Buffer in = gpu::Buffer::of<glsl::VirtualPointLight>(device(), "lights", lights),
                    clusters = gpu::Buffer::of<uint32_t>(device(), "mapping", mapping),
                    out = gpu::Buffer::of<glsl::VirtualPointLight>(device(), "sorted", Lights(count));
  gpu::Program& program =
      shaders().program({.files = {"glsl/indirect/cluster_sort.comp.glsl"}, .defines = {}});
  program.use();
  program.set("light_count", count);
  program.set("block", 1u);
  bindByName(gl(), program, "VirtualLights", in);
  bindByName(gl(), program, "Mapping", clusters);
  bindByName(gl(), program, "Sorted", out);
  gl().DispatchCompute(1, 1, 1);
  gl().MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  Lights sorted(group + 1);
  out.read(0, sorted.data(), sorted.size() * sizeof(sorted[0]));
  for (uint32_t i = 0; i < group; ++i) EXPECT_EQ(sorted[i + 1].flux.x, lights[i].flux.x);
}

/// The lights moved a little: the clusters follow.
TEST_F(VirtualAreasTest, FollowTheirLights) {
  const indirect::VirtualAreaDesc desc{.count = 30};
  const Clusters still = cluster(room(900), desc);
  const Clusters moved = cluster(room(900, 5, {0.01f, 0.005f, 0}), desc);
  for (size_t k = 0; k < still.areas.size(); ++k)
    EXPECT_LT(glm::length(vec3(moved.areas[k].position - still.areas[k].position)), 0.05f) << k;
}

}  // namespace
}  // namespace limn
