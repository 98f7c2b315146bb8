#include "core/indirect/virtual_areas.h"

#include <algorithm>
#include <functional>

#include "glsl/shadow/shadow_view.glsl"

namespace limn::indirect {
namespace {

using frame::Access;
using frame::BufferHandle;

constexpr int kLightsPerGroup = 64;

/// Diagonal of the scene's bounds, m.
float diagonalOf(const scene::GpuScene& scene) {
  const scene::Bounds& box = scene.bounds();
  return box.empty() ? 1.f : std::max(glm::length(box.high - box.low), 1e-30f);
}

struct AreaBuilder {
  frame::FrameGraph& graph;
  const scene::GpuScene& scene;
  const VirtualAreaDesc& desc;
  BufferHandle lights;
  int lightCount, clusterCount;
  BufferHandle clusters = {}, mapping = {}, views = {}, sorted = {};

  using Uniforms = std::function<void(gpu::Program&)>;
  frame::PassBuilder pass(const char* name) const {
    frame::PassBuilder builder = graph.addPass(name, desc.technique);
    builder.read(lights, Access::storageLoad, "VirtualLights", "virtual point lights").cacheable();
    return builder;
  }
  void execute(frame::PassBuilder& builder, const char* file, int groups, Uniforms uniforms) const {
    const auto program = builder.program({.files = {file}, .defines = {}});
    builder.execute([=, count = lightCount, uniforms = std::move(uniforms)](frame::PassContext& context) {
      gpu::Program& kernel = context.use(program);
      kernel.set("light_count", static_cast<unsigned>(count));
      if (uniforms) uniforms(kernel);
      context.dispatch(groups, 1, 1, 1, 1);
    });
  }
  static int groupsOf(int count) { return (count + kLightsPerGroup - 1) / kLightsPerGroup; }

  void start();
  void assign(const char* name);
  void average();
  void area();
  void sort();
};

void AreaBuilder::start() {
  frame::PassBuilder builder = pass("cluster start");
  clusters = graph.createBuffer("clusters", {clusterCount * sizeof(glsl::VirtualAreaLight)});
  clusters =
      builder.write(clusters, Access::storageStore, "Clusters", "centres: virtual lights floor(k N / M)");
  execute(
      builder, "glsl/indirect/cluster_start.comp.glsl", groupsOf(clusterCount),
      [m = clusterCount](gpu::Program& kernel) { kernel.set("cluster_count", static_cast<unsigned>(m)); });
}

void AreaBuilder::assign(const char* name) {
  frame::PassBuilder builder = pass(name);
  builder.read(clusters, Access::storageLoad, "Clusters", "centres");
  if (!mapping) mapping = graph.createBuffer("cluster mapping", {lightCount * sizeof(uint32_t)});
  mapping = builder.write(mapping, Access::storageStore, "Mapping", "nearest cluster of each virtual light");
  execute(builder, "glsl/indirect/cluster_assign.comp.glsl", groupsOf(lightCount),
          [m = clusterCount, d = desc, scene = &scene](gpu::Program& kernel) {
            kernel.set("cluster_count", static_cast<unsigned>(m));
            kernel.set("per_extent", 1 / diagonalOf(*scene));
            kernel.set("weight_position", d.weightPosition);
            kernel.set("weight_angle", d.weightAngle);
          });
}

void AreaBuilder::average() {
  frame::PassBuilder builder = pass("cluster average");
  builder.read(mapping, Access::storageLoad, "Mapping", "members");
  clusters =
      builder.write(clusters, Access::storageLoadStore, "Clusters", "mean position and normal of each");
  execute(builder, "glsl/indirect/cluster_average.comp.glsl", clusterCount, {});
}

void AreaBuilder::area() {
  frame::PassBuilder builder = pass("cluster area");
  builder.read(mapping, Access::storageLoad, "Mapping", "members");
  clusters = builder.write(clusters, Access::storageLoadStore, "Clusters", "rectangle around the members");
  views = graph.createBuffer("cluster views", {clusterCount * sizeof(glsl::ShadowView)});
  views = builder.write(views, Access::storageStore, "Views", "hemispheres of the maps");
  execute(builder, "glsl/indirect/cluster_area.comp.glsl", clusterCount,
          [d = desc, scene = &scene](gpu::Program& kernel) {
            const float extent = diagonalOf(*scene);
            kernel.set("near", d.near * extent);
            kernel.set("far", 1.01f * extent);
            kernel.set("map_size", static_cast<unsigned>(d.mapSize));
          });
}

void AreaBuilder::sort() {
  frame::PassBuilder builder = pass("cluster sort");
  builder.read(mapping, Access::storageLoad, "Mapping", "clusters");
  sorted = graph.createBuffer("sorted virtual lights", {lightCount * sizeof(glsl::VirtualPointLight)});
  sorted = builder.write(sorted, Access::storageStore, "Sorted", "by cluster within each sub-buffer");
  execute(builder, "glsl/indirect/cluster_sort.comp.glsl", groupsOf(lightCount),
          [block = desc.block](gpu::Program& kernel) { kernel.set("block", static_cast<unsigned>(block)); });
}

}  // namespace

VirtualAreas addVirtualAreas(frame::FrameGraph& graph, const scene::GpuScene& scene,
                             frame::BufferHandle lights, int count, const VirtualAreaDesc& desc) {
  AreaBuilder build{graph, scene, desc, lights, count, std::clamp(desc.count, 1, count)};
  build.start();
  for (int i = 0; i < desc.iterations; ++i) {
    build.assign("cluster assignment");
    build.average();
  }
  build.assign("cluster mapping");
  // The means are those of the final mapping.
  build.average();
  build.area();
  build.sort();
  return {build.clusters, build.views, build.sorted, build.clusterCount};
}

}  // namespace limn::indirect
