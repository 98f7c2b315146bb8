#include "core/shadow/private/summed_area_passes.h"

#include <fmt/format.h>

#include "core/base/error.h"

namespace limn::shadow {
namespace {

using frame::Access;
using frame::TextureHandle;

constexpr int64_t kMemoryLimit = int64_t{4} << 30;  // bytes of one derived map

void checkBytes(std::string_view what, const gpu::TextureDesc& desc) {
  const int64_t bytes = gpu::textureBytes(desc);
  if (bytes <= kMemoryLimit) return;
  throw UsageError(fmt::format(
      "{} of {} layers of {} x {} texels takes {} MiB, more than the {} MiB that one may; ask for a smaller "
      "shadow_map_size or fewer lights at once",
      what, desc.layers, desc.width, desc.height, bytes >> 20, kMemoryLimit >> 20));
}

/// Work groups for so many rows or columns; how many one takes is as in the shader.
int lineGroups(int lines, bool shared, bool vertical) {
  const int perGroup = shared && !vertical ? 4 : 16;
  return (lines + perGroup - 1) / perGroup;
}

}  // namespace

gpu::TextureDesc derivedDesc(const frame::FrameGraph& graph, TextureHandle source, std::string_view what,
                             GLenum format, int levels, int slices) {
  gpu::TextureDesc desc = graph.desc(source);
  if (desc.target != GL_TEXTURE_2D_ARRAY || desc.format != GL_R32F)
    throw Error(fmt::format("{}: the source is not an R32F array texture", what));
  desc.format = format;
  desc.levels = levels;
  desc.layers *= slices;
  desc = gpu::resolved(desc);
  checkBytes(what, desc);
  return desc;
}

TextureHandle addSummedAreaPasses(frame::FrameGraph& graph, TextureHandle source,
                                  const SummedAreaPasses& desc) {
  const gpu::TextureDesc texture = derivedDesc(graph, source, desc.name, desc.format, 1);
  TextureHandle table = graph.createTexture(desc.name, texture);
  for (const bool vertical : {false, true}) {
    frame::PassBuilder pass =
        graph.addPass(fmt::format("{} {}", desc.name, vertical ? "columns" : "rows"), "shadow");
    pass.role(frame::PassRole::filter);
    if (!vertical) pass.read(source, Access::sampled, "depth", "shadow maps");
    table = pass.write(table, vertical ? Access::imageLoadStore : Access::imageStore, "table",
                       vertical ? "sums along columns, in place" : "sums along rows");
    std::map<std::string, std::string> defines = desc.defines;
    defines["SHARED"] = desc.shared ? "1" : "0";
    defines["VERTICAL"] = vertical ? "1" : "0";
    const frame::ProgramHandle program =
        pass.program({.files = {"glsl/shadow/summed_area_table.comp.glsl"}, .defines = std::move(defines)});
    if (desc.cacheable) pass.cacheable();
    pass.execute([program, vertical, shared = desc.shared, texture](frame::PassContext& context) {
      context.use(program);
      const int groups = lineGroups(vertical ? texture.width : texture.height, shared, vertical);
      context.dispatch(groups, 1, texture.layers, 1, 1);
    });
  }
  return table;
}

}  // namespace limn::shadow
