#include "techniques/implicit_visibility/element_colours.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/gpu_scene/gpu_scene.h"
#include "glsl/numeric/sampling.glsl"

namespace limn::implicit_visibility {
namespace {

using frame::Access;

const glm::vec4 kGrey(0.15f, 0.15f, 0.15f, 1), kWhite(1);

glm::vec4 colourOf(uint32_t number) {
  return {glm::mix(glm::vec3(0.05f), glm::vec3(1), glm::vec3(glsl::pixel_noise(number, 17, 3))), 1};
}

}  // namespace

frame::BufferHandle ElementColours::colours(const PassRequest& r, Shown shown, int level) {
  if (shown != Shown::level && !elements_.linksOnProcessor())
    throw UsageError("implicit_visibility: show=links and show=bins go with links=cpu");
  Buffer& own = buffers_.emplace_back();
  own.values.resize(std::max(elements_.leafSlots(), 1u));
  own.buffer = gpu::Buffer(r.inputs.gpuScene.device(), "colours of leaves",
                           own.values.size() * sizeof(glm::vec4), gpu::BufferUse::updated);
  frame::PassBuilder pass = r.graph.addPass("colours of elements", technique_);
  if (shown == Shown::level) {
    pass.cacheable();  // the hierarchy stays as it was made
  } else {
    elements_.readInMemory(pass);
    pass.read(r.inputs.handles.frame, Access::uniformBuffer, "the camera, in the CPU's memory as well");
  }
  const frame::BufferHandle colours = pass.write(r.graph.importBuffer("colours of leaves", own.buffer),
                                                 Access::copyTarget, "a colour for each leaf");
  pass.execute([this, &own, shown, level, &scene = r.inputs.gpuScene,
                size = glm::vec2(r.inputs.size)](frame::PassContext&) {
    std::ranges::fill(own.values, kGrey);
    if (shown == Shown::level) {
      colourLevel(level, own.values);
    } else {
      const auto& frame = scene.frame();
      const glm::vec3 ray(frame.view_ray_origin + 0.5f * (size.x - 1) * frame.view_ray_dx +
                          0.5f * (size.y - 1) * frame.view_ray_dy);
      const uint32_t leaf = leafAt(glm::vec3(frame.camera_position), ray);
      if (leaf != glsl::no_link) colourLinks(leaf, shown == Shown::bins, own);
    }
    own.buffer.update(0, own.values.data(), own.values.size() * sizeof(glm::vec4));
  });
  return colours;
}

void ElementColours::colourLevel(int level, std::span<glm::vec4> values) const {
  const std::span<const uint32_t> parents = elements_.elements().forest().parents();
  for (uint32_t leaf = 0; leaf < elements_.leafSlots(); ++leaf) {
    uint32_t element = leaf;
    for (int i = 0; i < level && parents[element / 4] != glsl::no_link; ++i) element = parents[element / 4];
    values[leaf] = colourOf(element);
  }
}

void ElementColours::colourLinks(uint32_t leaf, bool bins, Buffer& own) const {
  // Each element that is linked colours the leaves below it: with its own colour, or that of the first bin.
  const std::span<const uint32_t> links = elements_.links().of(leaf);
  std::vector<uint32_t>& binOf = own.bins;
  binOf.assign(elements_.slots(), glsl::no_link);
  for (uint32_t bin = 0; bin < links.size(); ++bin) {
    if (links[bin] == glsl::no_link) continue;
    uint32_t& first = binOf[links[bin] & ~glsl::link_back];
    first = std::min(first, bin);
  }
  const std::span<const uint32_t> parents = elements_.elements().forest().parents();
  for (uint32_t other = 0; other < elements_.leafSlots(); ++other) {
    uint32_t element = other;
    while (binOf[element] == glsl::no_link && parents[element / 4] != glsl::no_link)
      element = parents[element / 4];
    if (binOf[element] != glsl::no_link) own.values[other] = colourOf(bins ? binOf[element] : element);
  }
  own.values[leaf] = kWhite;
}

uint32_t ElementColours::leafAt(const glm::vec3& from, const glm::vec3& ray) const {
  // Moller and Trumbore 1997, Fast, Minimum Storage Ray-Triangle Intersection.
  const std::span<const radiosity::Leaf> leaves = elements_.elements().leaves();
  const std::span<const uint32_t> corners = elements_.elements().triangles();
  uint32_t found = glsl::no_link;
  float nearest = std::numeric_limits<float>::max();
  for (size_t i = 0; i + 2 < corners.size(); i += 3) {
    const glm::vec3 a = leaves[corners[i]].vertex, ab = leaves[corners[i + 1]].vertex - a,
                    ac = leaves[corners[i + 2]].vertex - a, across = glm::cross(ray, ac);
    const float determinant = glm::dot(ab, across);
    const glm::vec3 offset = from - a, turned = glm::cross(offset, ab);
    const float v = glm::dot(offset, across) / determinant, w = glm::dot(ray, turned) / determinant,
                depth = glm::dot(ac, turned) / determinant;
    // A triangle without area has no such numbers: no comparison holds.
    if (!(determinant > 0 && v >= 0 && w >= 0 && v + w <= 1 && depth > 0 && depth < nearest)) continue;
    nearest = depth;
    const std::array<float, 3> weights{1 - v - w, v, w};
    found = corners[i + static_cast<size_t>(std::ranges::max_element(weights) - weights.begin())];
  }
  return found;
}

}  // namespace limn::implicit_visibility
