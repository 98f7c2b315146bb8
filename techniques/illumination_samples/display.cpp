#include "techniques/illumination_samples/display.h"

#include <algorithm>
#include <string>

#include "core/gpu_scene/gpu_scene.h"
#include "core/shading_maps/shading_maps.h"

namespace limn::illumination_samples {

using frame::Access;

frame::TextureHandle Display::show(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                   const Solution& solution, frame::TextureHandle target) {
  const frame::TextureHandle around = lookup_.texture(
      graph, inputs, {elements_.leaves, elements_.corners, elements_.elements().triangles().size()},
      settings_.technique);
  const frame::BufferHandle towards =
      settings_.shown == Shown::vertices ? towardsEye(graph, inputs, solution) : frame::BufferHandle{};
  frame::PassBuilder pass = graph.addPass(
      settings_.shown == Shown::gathered ? "gather per pixel" : "interpolate", settings_.technique);
  pass.read(inputs.handles.frame, Access::uniformBuffer, "FrameBlock", "camera")
      .read(around, Access::sampled, "surface_lookup", "leaves around pixels")
      .read(solution.irradiance, Access::storageLoad, "Irradiance", "diffuse light");
  readSurfaces(pass, inputs.gbuffer);
  if (settings_.shown == Shown::vertices) {
    pass.read(towards, Access::storageLoad, "Towards", "specular light towards the eye");
  } else if (settings_.shown == Shown::pixels) {
    readTrees(pass, solution);
  } else {
    pass.read(solution.ranges, Access::storageLoad, "Ranges", "which samples")
        .read(solution.samples, Access::storageLoad, "Samples", "light by directions")
        .read(elements_.leaves, Access::storageLoad, "Leaves", "places that near samples are seen from")
        .read(elements_.parents, Access::storageLoad, "Parents", "elements above leaves")
        .read(solution.senders, Access::storageLoad, "Senders", "where that light comes from")
        .read(inputs.service<shading_maps::ShadingMapService>().ltcTable(), Access::sampled, "ltc_table",
              "energy of lobes");
  }
  const frame::TextureHandle result =
      pass.write(target, Access::imageLoadStore, "radiance", "reflected light");
  const auto kernel =
      pass.program({.files = {"techniques/illumination_samples/show.comp.glsl"},
                    .defines = {{"DISPLAY", std::to_string(static_cast<int>(settings_.shown))}}});
  pass.execute([this, kernel, size = inputs.size](frame::PassContext& context) {
    gpu::Program& program = context.use(kernel);
    if (settings_.shown == Shown::gathered) program.set("widen", settings_.samples.widen);
    if (settings_.shown == Shown::pixels) setTrees(program);
    context.dispatch(size.x, size.y, 1, 8, 8);
  });
  const bool draws = settings_.drawTree && !inputs.bodyAlbedo;  // a tree is no light that enters surfaces
  return draws ? drawTree(graph, inputs, solution, around, result) : result;
}

frame::TextureHandle Display::drawTree(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                       const Solution& solution, frame::TextureHandle around,
                                       frame::TextureHandle picture) const {
  frame::PassBuilder pass = graph.addPass("draw a tree", settings_.technique);
  pass.read(inputs.handles.frame, Access::uniformBuffer, "FrameBlock", "camera")
      .read(around, Access::sampled, "surface_lookup", "the leaf in the middle");
  readTrees(pass, solution);
  const frame::TextureHandle result =
      pass.write(picture, Access::imageLoadStore, "radiance", "the tree in a corner");
  const auto kernel =
      pass.program({.files = {"techniques/illumination_samples/show_tree.comp.glsl"}, .defines = {}});
  pass.execute([this, kernel, size = inputs.size](frame::PassContext& context) {
    setTrees(context.use(kernel));
    context.dispatch(size.x, size.y, 1, 8, 8);
  });
  return result;
}

void Display::readTrees(frame::PassBuilder& pass, const Solution& solution) const {
  pass.read(elements_.leaves, Access::storageLoad, "Leaves", "normals")
      .read(solution.trees, Access::storageLoad, "Trees", "where trees begin")
      .read(solution.nodes, Access::storageLoad, "DirectionNodes", "light by directions");
}

void Display::setTrees(gpu::Program& program) const {
  const bool uniform = settings_.shownTree.basis == radiosity::TreeSettings::Basis::uniform;
  program.set("grid", uniform ? 1u << settings_.shownTree.maxLevel : 0u);
}

frame::BufferHandle Display::towardsEye(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                        const Solution& solution) {
  frame::BufferHandle& towards = towards_[&solution];
  if (towards) return towards;
  const uint32_t count = elements_.elements().forest().leafSlots();
  frame::PassBuilder pass = graph.addPass("towards the eye", settings_.technique);
  pass.read(inputs.handles.frame, Access::uniformBuffer, "FrameBlock", "camera");
  readTrees(pass, solution);
  towards = pass.write(graph.createBuffer("light towards the eye", {std::max(count, 1u) * sizeof(glm::vec4)}),
                       Access::storageStore, "Towards", "of leaves");
  const auto kernel =
      pass.program({.files = {"techniques/illumination_samples/towards_eye.comp.glsl"}, .defines = {}});
  pass.execute([this, kernel, count](frame::PassContext& context) {
    gpu::Program& program = context.use(kernel);
    setTrees(program);
    program.set("leaf_count", count);
    context.dispatchRows((int64_t{count} + 63) / 64);
  });
  return towards;
}

}  // namespace limn::illumination_samples
