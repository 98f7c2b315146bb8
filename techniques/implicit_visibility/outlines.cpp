#include "techniques/implicit_visibility/outlines.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/gpu_scene/gpu_scene.h"

namespace limn::implicit_visibility {

using frame::Access;
using radiosity::BlockerLists;
using radiosity::LightBounds;

std::optional<OutlineLists> Outlines::lists(const PassRequest& r, std::span<const uint32_t> lights) {
  if (r.inputs.pose.lights.size() > kMostLights) return std::nullopt;
  gpu::Device& device = r.inputs.gpuScene.device();
  Lists& own = lists_.emplace_back();
  own.lights.assign(lights.begin(), lights.end());
  const size_t count = std::max<size_t>(lights.size(), 1);
  const size_t leaves = std::max<size_t>(elements_.leafSlots(), 1);
  const size_t most = static_cast<size_t>(device.limits().maxStorageBlockBytes) / sizeof(uint32_t);
  const size_t perLight = std::min(kPerLeaf * leaves, most / count);
  own.ranges = gpu::Buffer(device, "ranges of lists", count * leaves * sizeof(BlockerLists::Range),
                           gpu::BufferUse::updated);
  own.triangles =
      gpu::Buffer(device, "lists of triangles", count * perLight * sizeof(uint32_t), gpu::BufferUse::updated);
  frame::PassBuilder pass = r.graph.addPass("list outlines", technique_);
  elements_.readInMemory(pass);
  pass.read(r.inputs.handles.lights, Access::storageLoad, "lights, in the CPU's memory as well").cacheable();
  OutlineLists result;
  result.ranges =
      pass.write(r.graph.importBuffer(fmt::format("ranges of lists {}", lists_.size()), own.ranges),
                 Access::copyTarget, "where the leaves' lists lie");
  result.triangles =
      pass.write(r.graph.importBuffer(fmt::format("lists of triangles {}", lists_.size()), own.triangles),
                 Access::copyTarget, "triangles that may hide a light from around a leaf");
  pass.execute([this, &own, perLight, &pose = r.inputs.pose](frame::PassContext&) {
    own.bounds.clear();
    for (const uint32_t light : own.lights) own.bounds.push_back(LightBounds::of(pose.lights[light]));
    own.lists.build(elements_.elements(), elements_.linksOnProcessor() ? &elements_.links() : nullptr,
                    own.bounds, perLight);
    own.ranges.update(0, own.lists.ranges().data(), own.lists.ranges().size_bytes());
    own.triangles.update(0, own.lists.triangles().data(), own.lists.triangles().size_bytes());
  });
  return result;
}

}  // namespace limn::implicit_visibility
