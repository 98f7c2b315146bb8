#include "core/shadow/derived_maps.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "glsl/summed_area_table.glsl"

namespace limn::shadow {
namespace {

using frame::Access;
using frame::TextureHandle;

constexpr int64_t memoryLimit = int64_t{4} << 30;  // bytes of one derived map

enum class PyramidKind { minMax, moments };

struct KnownTable {
  TextureHandle source;
  SatDesc desc;
  SummedAreaTable table;
};

struct KnownPyramid {
  TextureHandle source;
  PyramidKind kind;
  TextureHandle texture;
};

std::string_view nameOf(PyramidKind kind) {
  return kind == PyramidKind::minMax ? "min-max pyramid" : "moment mips";
}

void checkBytes(std::string_view what, const gpu::TextureDesc& desc) {
  const int64_t bytes = gpu::textureBytes(desc);
  if (bytes <= memoryLimit) return;
  throw UsageError(fmt::format(
      "{} of {} layers of {} x {} texels takes {} MiB, more than the {} MiB that one may; ask for a smaller "
      "shadow_map_size or fewer lights at once",
      what, desc.layers, desc.width, desc.height, bytes >> 20, memoryLimit >> 20));
}

/// The description of a map derived from `source`.
gpu::TextureDesc derivedDesc(const frame::FrameGraph& graph, TextureHandle source, std::string_view what,
                             GLenum format, int levels) {
  gpu::TextureDesc desc = graph.desc(source);
  if (desc.target != GL_TEXTURE_2D_ARRAY || desc.format != GL_R32F)
    throw Error(fmt::format("{}: the source is not an R32F array texture", what));
  desc.format = format;
  desc.levels = levels;
  desc = gpu::resolved(desc);
  checkBytes(what, desc);
  return desc;
}

/// Level 0 from the shadow maps, each further level from the one before: a pass each, so that the graph puts
/// the barriers between them.
TextureHandle addPyramid(frame::FrameGraph& graph, TextureHandle source, PyramidKind kind, bool cacheable) {
  const gpu::TextureDesc desc = derivedDesc(graph, source, nameOf(kind), GL_RG32F, 0);
  TextureHandle pyramid = graph.createTexture(nameOf(kind), desc);
  const std::string moments = kind == PyramidKind::moments ? "1" : "0";
  for (int level = 0; level < desc.levels; ++level) {
    frame::PassBuilder pass = graph.addPass(fmt::format("{} level {}", nameOf(kind), level), "shadow");
    if (level == 0) pass.read(source, Access::sampled, "shadow maps");
    pyramid = pass.write(pyramid, level == 0 ? Access::imageStore : Access::imageLoadStore,
                         level == 0 ? "finest level" : "next level from the one before");
    const frame::ProgramHandle program =
        pass.program({.files = {"glsl/shadow/pyramid.comp.glsl"},
                      .defines = {{"BASE", level == 0 ? "1" : "0"}, {"MOMENTS", moments}}});
    if (cacheable) pass.cacheable();
    pass.execute([source, pyramid, program, level, desc](frame::PassContext& context) {
      context.program(program).use();
      if (level == 0) {
        context.bindSampled(0, source);
      } else {
        context.bindImage(1, pyramid, GL_READ_ONLY, level - 1);
      }
      context.bindImage(0, pyramid, GL_WRITE_ONLY, level);
      context.dispatch(std::max(desc.width >> level, 1), std::max(desc.height >> level, 1), desc.layers, 8,
                       8);
    });
  }
  return pyramid;
}

/// Fills in what the description leaves to us.
SatDesc resolved(SatDesc desc, bool software) {
  if (desc.bits < 8 || desc.bits > 24)
    throw UsageError(fmt::format("summed-area table of {} bits: accepted are 8 to 24", desc.bits));
  if (desc.words < 0 || desc.words > 2)
    throw UsageError(fmt::format(
        "summed-area table with {} words per moment: accepted are 1, 2 and 0 (by moments)", desc.words));
  if (desc.words == 0) desc.words = desc.moments == SatMoments::z ? 1 : 2;
  if (desc.method == SatMethod::automatic)
    desc.method = software ? SatMethod::rowParallel : SatMethod::sharedMemory;
  return desc;
}

struct TableFormat {
  GLenum gl;
  const char* glsl;
};

TableFormat tableFormat(const SatDesc& desc) {
  const int words = desc.words * (desc.moments == SatMoments::z ? 1 : 2);
  if (words == 1) return {GL_R32UI, "r32ui"};
  return words == 2 ? TableFormat{GL_RG32UI, "rg32ui"} : TableFormat{GL_RGBA32UI, "rgba32ui"};
}

/// Work groups for so many rows or columns; how many one takes is as in the shader.
int lineGroups(int lines, bool shared, bool vertical) {
  const int perGroup = shared && !vertical ? 4 : 16;
  return (lines + perGroup - 1) / perGroup;
}

SummedAreaTable addTable(frame::FrameGraph& graph, TextureHandle source, const SatDesc& desc,
                         bool cacheable) {
  const TableFormat format = tableFormat(desc);
  const bool shared = desc.method == SatMethod::sharedMemory;
  const gpu::TextureDesc texture = derivedDesc(graph, source, "summed-area table", format.gl, 1);
  SummedAreaTable table{graph.createTexture("summed-area table", texture),
                        glsl::sat_format(static_cast<uint32_t>(desc.bits), static_cast<uint32_t>(desc.words),
                                         desc.moments == SatMoments::zAndSquare ? 1 : 0)};
  for (const bool vertical : {false, true}) {
    frame::PassBuilder pass =
        graph.addPass(vertical ? "summed-area table columns" : "summed-area table rows", "shadow");
    if (!vertical) pass.read(source, Access::sampled, "shadow maps");
    table.texture = pass.write(table.texture, vertical ? Access::imageLoadStore : Access::imageStore,
                               vertical ? "sums along columns, in place" : "sums along rows");
    const frame::ProgramHandle program =
        pass.program({.files = {"glsl/shadow/summed_area_table.comp.glsl"},
                      .defines = {{"SHARED", shared ? "1" : "0"},
                                  {"IMAGE_FORMAT", format.glsl},
                                  {"TABLE_FORMAT", fmt::format("{}u", table.format)},
                                  {"VERTICAL", vertical ? "1" : "0"}}});
    if (cacheable) pass.cacheable();
    pass.execute([source, table, program, vertical, shared, texture](frame::PassContext& context) {
      context.program(program).use();
      if (!vertical) context.bindSampled(0, source);
      context.bindImage(0, table.texture, vertical ? GL_READ_WRITE : GL_WRITE_ONLY);
      const int groups = lineGroups(vertical ? texture.width : texture.height, shared, vertical);
      context.dispatch(groups, 1, texture.layers, 1, 1);
    });
  }
  return table;
}

}  // namespace

struct DerivedMaps::Implementation {
  const gpu::Device& device;
  frame::FrameGraph* graph = nullptr;
  std::vector<KnownPyramid> pyramids = {};
  std::vector<KnownTable> tables = {};

  TextureHandle pyramid(TextureHandle source, PyramidKind kind, bool cacheable) {
    for (const KnownPyramid& known : pyramids) {
      if (known.source == source && known.kind == kind) return known.texture;
    }
    pyramids.push_back({source, kind, addPyramid(*graph, source, kind, cacheable)});
    return pyramids.back().texture;
  }
};

DerivedMaps::DerivedMaps(const gpu::Device& device) : implementation_(new Implementation{.device = device}) {}
DerivedMaps::~DerivedMaps() = default;

void DerivedMaps::begin(frame::FrameGraph& graph) {
  implementation_->graph = &graph;
  implementation_->pyramids.clear();
  implementation_->tables.clear();
}

MinMaxPyramid DerivedMaps::minMaxPyramid(TextureHandle depth, bool cacheable) {
  const TextureHandle texture = implementation_->pyramid(depth, PyramidKind::minMax, cacheable);
  return {texture, implementation_->graph->desc(texture).levels};
}

SummedAreaTable DerivedMaps::summedAreaTable(TextureHandle depth, bool cacheable, const SatDesc& desc) {
  Implementation& d = *implementation_;
  const SatDesc full = resolved(desc, d.device.software());
  for (const KnownTable& known : d.tables) {
    if (known.source == depth && known.desc == full) return known.table;
  }
  d.tables.push_back({depth, full, addTable(*d.graph, depth, full, cacheable)});
  return d.tables.back().table;
}

TextureHandle DerivedMaps::momentMips(TextureHandle depth, bool cacheable) {
  return implementation_->pyramid(depth, PyramidKind::moments, cacheable);
}

}  // namespace limn::shadow
