#include "core/shadow/private/summed_area_passes.h"

#include <fmt/format.h>

#include <utility>

#include "core/base/error.h"
#include "core/shadow/private/map_memory.h"

namespace limn::shadow {
namespace {

using frame::Access;
using frame::TextureHandle;

void checkBytes(std::string_view what, const gpu::TextureDesc& desc) {
  const int64_t bytes = gpu::textureBytes(desc);
  if (bytes <= kMemoryLimit) return;
  throw UsageError(fmt::format(
      "{} of {} layers of {} x {} texels takes {} MiB, more than the {} MiB that one may; ask for a smaller "
      "shadow_map_size or fewer lights at once",
      what, desc.layers, desc.width, desc.height, bytes >> 20, kMemoryLimit >> 20));
}

const char* imageFormat(GLenum format) {
  switch (format) {
    case GL_R32UI:
      return "r32ui";
    case GL_RG32UI:
      return "rg32ui";
    case GL_RGBA32UI:
      return "rgba32ui";
    case GL_R32I:
      return "r32i";
    default:
      return "rgba32i";
  }
}

frame::ProgramHandle sumProgram(frame::PassBuilder& pass, const SummedAreaPasses& desc, GLenum format,
                                bool vertical) {
  std::map<std::string, std::string> defines = desc.defines;
  defines["IMAGE_FORMAT"] = imageFormat(format);
  defines["SHARED"] = desc.shared ? "1" : "0";
  defines["VERTICAL"] = vertical ? "1" : "0";
  return pass.program({.files = {"glsl/shadow/summed_area_table.comp.glsl"}, .defines = std::move(defines)});
}

frame::PassBuilder addPass(frame::FrameGraph& graph, const SummedAreaPasses& desc,
                           std::string_view direction) {
  frame::PassBuilder pass = graph.addPass(fmt::format("{} {}", desc.name, direction), "shadow");
  pass.role(frame::PassRole::filter);
  if (desc.cacheable) pass.cacheable();
  return pass;
}

}  // namespace

int lineGroups(int lines, bool shared, bool vertical) {
  const int perGroup = shared && !vertical ? 4 : 16;
  return (lines + perGroup - 1) / perGroup;
}

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

TextureHandle addSummedAreaPasses(frame::FrameGraph& graph, TextureHandle source, GLenum format,
                                  const SummedAreaPasses& desc) {
  const gpu::TextureDesc texture = derivedDesc(graph, source, desc.name, format, 1);
  frame::PassBuilder pass = addPass(graph, desc, "rows");
  pass.read(source, Access::sampled, "depth", "shadow maps");
  TextureHandle table =
      pass.write(graph.createTexture(desc.name, texture), Access::imageStore, "table", "sums along rows");
  const frame::ProgramHandle program = sumProgram(pass, desc, format, false);
  pass.execute([program, texture, shared = desc.shared](frame::PassContext& context) {
    context.use(program);
    context.dispatch(lineGroups(texture.height, shared, false), 1, texture.layers, 1, 1);
  });
  addColumnSums(graph, {&table}, desc);
  return table;
}

void addColumnSums(frame::FrameGraph& graph, const std::vector<TextureHandle*>& tables,
                   const SummedAreaPasses& desc) {
  frame::PassBuilder pass = addPass(graph, desc, "columns");
  const frame::SlotHandle slot = pass.slot("table");
  struct Columns {
    TextureHandle table;
    frame::ProgramHandle program;
    int groups, layers;
  };
  std::vector<Columns> all;
  for (TextureHandle* table : tables) {
    *table = pass.write(*table, Access::imageLoadStore, "sums along columns, in place");
    const gpu::TextureDesc& texture = graph.desc(*table);
    all.push_back({*table, sumProgram(pass, desc, texture.format, true),
                   lineGroups(texture.width, desc.shared, true), texture.layers});
  }
  pass.execute([slot, all = std::move(all)](frame::PassContext& context) {
    for (const Columns& columns : all) {
      context.use(columns.program);
      context.bind(slot, columns.table);
      context.dispatch(columns.groups, 1, columns.layers, 1, 1);
    }
  });
}

}  // namespace limn::shadow
