// Caustic rays sorted by kind against the lists that a loop makes.
#include "core/caustics/ray_lists.h"

#include <fmt/format.h>

#include <array>
#include <random>
#include <vector>

#include "tests/gpu/frame_graph_harness.h"

namespace limn::caustics {
namespace {

/// The kind of a ray stands in place of what its end is.
constexpr const char* kKindShader = R"(
#include "glsl/caustics/caustic_ray.glsl"
layout(std430) readonly buffer Rays { CausticRay rays[]; };
uint ray_kind(int index) { return uint(rays[index].kind); }
#include "glsl/caustics/ray_kinds.glsl"
)";

class RayListsTest : public frame::FrameGraphGpu {};

TEST_F(RayListsTest, HoldEachRayOnceByKindAndInOrder) {
  const gpu::EmbeddedSource kSources[] = {{"kind.comp.glsl", kKindShader}};
  shaders().mount("test/", kSources);
  std::mt19937 random(3);
  constexpr int kRun = glsl::rays_per_run, kGroup = kRun * glsl::runs_per_group;
  // What a single work group of 256 threads adds up in one go.
  constexpr int kPart = 256 * kGroup;
  // Highest kinds: 0: all rays are of the first, 3: of each kind, or not drawn; 4: none is drawn.
  for (const int count : {1, kRun - 1, kRun, kRun + 1, kGroup - 1, kGroup, kGroup + 1, 90601, kPart - 1,
                          kPart, kPart + 1, 2 * kPart + 12345})
    for (const uint32_t highest : {0u, 3u, 4u}) {
      SCOPED_TRACE(fmt::format("{} rays, kinds up to {}", count, highest));
      std::vector<glsl::CausticRay> rays(static_cast<size_t>(count));
      std::array<std::vector<uint32_t>, glsl::ray_kinds> expected;
      for (uint32_t i = 0; i < rays.size(); ++i) {
        const uint32_t kind = highest == 4 ? 3 : std::uniform_int_distribution<uint32_t>(0, highest)(random);
        rays[i].kind = static_cast<float>(kind);
        if (kind < glsl::ray_kinds) expected[kind].push_back(i);
      }
      const auto buffer = gpu::Buffer::of<glsl::CausticRay>(device(), "rays", rays);
      frame::FrameGraph graph;
      CausticRays made;
      made.rays = graph.importBuffer("rays", buffer);
      made.size = made.paths = 1;
      made.layers = count;
      const RayLists lists =
          addRayLists(graph, made,
                      {.technique = "test",
                       .program = {.files = {"test/kind.comp.glsl"}, .defines = {}},
                       .kinds = {{{.vertices = 2}, {.vertices = 1}, {.vertices = 6, .instances = true}}}});
      graph.output(lists.indices);
      graph.output(lists.draws);
      prepare(graph);
      graph.execute();

      std::vector<uint32_t> indices(rays.size());
      graph.buffer(lists.indices).read(0, indices.data(), indices.size() * sizeof(uint32_t));
      struct {
        std::array<glsl::RayDraw, glsl::ray_kinds> commands;
        std::array<uint32_t, glsl::ray_kinds> firstPlaces;
      } draws;
      graph.buffer(lists.draws).read(0, &draws, sizeof(draws));
      const auto size = [&](uint32_t kind) { return static_cast<uint32_t>(expected[kind].size()); };
      EXPECT_EQ(draws.commands[0].vertices, 2 * size(0));
      EXPECT_EQ(draws.commands[0].instances, 1u);
      EXPECT_EQ(draws.commands[1].vertices, size(1));
      EXPECT_EQ(draws.commands[1].instances, 1u);
      EXPECT_EQ(draws.commands[2].vertices, 6u);
      EXPECT_EQ(draws.commands[2].instances, size(2));
      for (uint32_t kind = 0; kind < glsl::ray_kinds; ++kind) {
        EXPECT_EQ(draws.commands[kind].first_vertex, 0u);
        EXPECT_EQ(draws.commands[kind].first_instance, 0u);
        const uint32_t first = draws.firstPlaces[kind];
        ASSERT_LE(first + size(kind), indices.size());
        EXPECT_TRUE(std::equal(expected[kind].begin(), expected[kind].end(), indices.begin() + first))
            << kind;
      }
    }
}

}  // namespace
}  // namespace limn::caustics
