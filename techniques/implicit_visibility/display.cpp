#include "techniques/implicit_visibility/display.h"

#include <map>
#include <string>
#include <utility>

namespace limn::implicit_visibility {

using frame::Access;

frame::TextureHandle Display::lookup(const PassRequest& r) {
  return lookup_.texture(r.graph, r.inputs,
                         {elements_.leaves, elements_.corners, elements_.elements().triangles().size()},
                         technique_);
}

frame::TextureHandle Display::visibility(const PassRequest& r, const SeenLights& seen,
                                         const std::optional<OutlineLists>& lists) {
  const frame::TextureHandle around = lookup(r);
  frame::PassBuilder pass = r.graph.addPass("visibility", technique_);
  pass.read(r.inputs.handles.frame, Access::uniformBuffer, "FrameBlock", "camera")
      .read(r.inputs.gbuffer.depth, Access::sampled, kGBufferNames.depth, "where surfaces are")
      .read(around, Access::sampled, "surface_lookup", "leaves around pixels")
      .read(seen.seen, Access::storageLoad, "Seen", "V of leaves");
  if (lists) {
    pass.read(r.inputs.gbuffer.geometricNormal, Access::sampled, kGBufferNames.geometricNormal,
              "tangent planes")
        .read(r.inputs.handles.lights, Access::storageLoad, "Lights", "lights")
        .read(seen.indices, Access::storageLoad, "Indices", "which lights")
        .read(elements_.leaves, Access::storageLoad, "Leaves", "vertices")
        .read(elements_.corners, Access::storageLoad, "Corners", "triangles")
        .read(lists->ranges, Access::storageLoad, "Ranges", "where the leaves' lists lie")
        .read(lists->triangles, Access::storageLoad, "Lists", "what may hide a light");
  }
  const frame::TextureHandle result =
      pass.write(r.target, Access::imageStore, "visibility", "visibility, one layer per light");
  const auto kernelHandle =
      elements_.program(pass, "show_visibility.comp.glsl", {{"LISTED", lists ? "1" : "0"}});
  pass.execute([this, kernelHandle, size = r.inputs.size, layers = r.graph.desc(r.target).layers,
                listed = lists.has_value(), &parameters = r.inputs.parameters](frame::PassContext& context) {
    gpu::Program& kernel = context.use(kernelHandle);
    kernel.set("slots", elements_.leafSlots());
    if (listed) {
      kernel.set("reach", parameters.real("reach"));
      kernel.set("unit", elements_.elements().space().radius());
    }
    context.dispatch(size.x, size.y, layers, 8, 8);
  });
  return result;
}

frame::TextureHandle Display::colours(const PassRequest& r, frame::BufferHandle colours) {
  const frame::TextureHandle around = lookup(r);
  frame::PassBuilder pass = r.graph.addPass("show colours", technique_);
  pass.read(r.inputs.handles.frame, Access::uniformBuffer, "FrameBlock", "camera")
      .read(r.inputs.gbuffer.depth, Access::sampled, kGBufferNames.depth, "where surfaces are")
      .read(r.inputs.gbuffer.geometricNormal, Access::sampled, kGBufferNames.geometricNormal,
            "which way they face")
      .read(around, Access::sampled, "surface_lookup", "leaves around pixels")
      .read(colours, Access::storageLoad, "Colours", "of leaves");
  const frame::TextureHandle result =
      pass.write(r.target, Access::imageLoadStore, "radiance", "colours of elements");
  const auto kernelHandle = elements_.program(pass, "show_colours.comp.glsl");
  pass.execute([kernelHandle, size = r.inputs.size](frame::PassContext& context) {
    context.use(kernelHandle);
    context.dispatch(size.x, size.y, 1, 8, 8);
  });
  return result;
}

frame::TextureHandle Display::light(const PassRequest& r, const Gathered& light) {
  if (r.inputs.parameters.choice("display") == 0) return show(r, light, nullptr);
  frame::TextureHandle target = r.target;
  for (const LinkChunk& chunk : elements_.chunks) target = show({r.graph, r.inputs, target}, light, &chunk);
  return target;
}

frame::TextureHandle Display::show(const PassRequest& r, const Gathered& light, const LinkChunk* chunk) {
  const frame::TextureHandle around = lookup(r);
  frame::PassBuilder pass = r.graph.addPass(chunk ? "gather per pixel" : "interpolate", technique_);
  pass.read(r.inputs.handles.frame, Access::uniformBuffer, "FrameBlock", "camera")
      .read(around, Access::sampled, "surface_lookup", "leaves around pixels");
  readSurfaces(pass, r.inputs.gbuffer);
  frame::SlotHandle links;
  if (chunk) {
    pass.read(light.source, Access::storageLoad, "Source", "light");
    elements_.readDirections(pass);
    links = elements_.readLinks(pass);
  } else {
    pass.read(light.irradiance, Access::storageLoad, "Irradiance", "light");
  }
  const frame::TextureHandle result =
      pass.write(r.target, Access::imageLoadStore, "radiance", "reflected light");
  std::map<std::string, std::string> defines;
  if (chunk) elements_.readSky(pass, r.inputs, light.sky, defines);
  const auto kernelHandle =
      elements_.program(pass, chunk ? "show_bins.comp.glsl" : "show_light.comp.glsl", std::move(defines));
  pass.execute([this, kernelHandle, links, own = chunk ? *chunk : LinkChunk{}, perPixel = chunk != nullptr,
                size = r.inputs.size](frame::PassContext& context) {
    gpu::Program& kernel = context.use(kernelHandle);
    if (perPixel) {
      elements_.setSpace(kernel);
      ElementPasses::bind(context, kernel, links, own);
    }
    context.dispatch(size.x, size.y, 1, 8, 8);
  });
  return result;
}

}  // namespace limn::implicit_visibility
