#include "core/shadow/derived_maps.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/shadow/private/summed_area_passes.h"
#include "glsl/shadow/min_max_pyramid.glsl"
#include "glsl/shadow/min_max_windows.glsl"
#include "glsl/shadow/n_buffer.glsl"
#include "glsl/shadow/summed_area_table.glsl"

namespace limn::shadow {
namespace {

using frame::Access;
using frame::TextureHandle;

struct KnownTable {
  TextureHandle source;
  SatDesc desc;
  SummedAreaTable table;
};

struct KnownPyramid {
  TextureHandle source;
  MinMaxPyramid pyramid;
};

struct KnownMoments {
  TextureHandle source;
  MomentTable table;
};

/// Derived from `source` in the one way there is.
struct KnownTexture {
  TextureHandle source, texture;
};

/// Returns what is known to be derived from `source`; `add` makes it where nothing is.
template <class Add>
TextureHandle knownOr(std::vector<KnownTexture>& known, TextureHandle source, const Add& add) {
  const auto found = std::ranges::find(known, source, &KnownTexture::source);
  if (found != known.end()) return found->texture;
  known.push_back({source, add()});
  return known.back().texture;
}

/// What shaders call the levels of a pass, the one that it starts from first.
constexpr std::array<const char*, 4> kLevelImages{"level_0", "level_1", "level_2", "level_3"};

std::string passName(std::string_view map, int first, int last) {
  return first == last ? fmt::format("{} level {}", map, last)
                       : fmt::format("{} levels {} to {}", map, first, last);
}

/// The levels that boxes of up to `side` texels are looked up in (glsl/shadow/min_max_pyramid.glsl); 0: all.
int pyramidLevels(const gpu::TextureDesc& maps, int side) {
  const int all = gpu::fullMipLevels(maps.width, maps.height);
  return side > 0 ? glsl::min_max_level(side, all) + 1 : all;
}

/// The first pass makes level 0 and the next ones from the shadow maps, each further pass up to three
/// from the last level of the pass before: a dispatch of a small level waits longer than it works.
TextureHandle addMinMaxPyramid(frame::FrameGraph& graph, TextureHandle source, bool cacheable, int levels) {
  constexpr std::string_view name = "min-max pyramid";
  const gpu::TextureDesc desc = derivedDesc(graph, source, name, GL_RG32F, levels);
  TextureHandle pyramid = graph.createTexture(name, desc);
  int last = 0;  // level made so far, and the one that the next pass starts from
  do {
    const bool base = last == 0;
    const int first = last;
    last = std::min(first + static_cast<int>(kLevelImages.size()) - 1, desc.levels - 1);
    frame::PassBuilder pass = graph.addPass(passName(name, base ? 0 : first + 1, last), "shadow");
    pass.role(frame::PassRole::filter);
    if (base) pass.read(source, Access::sampled, "depth", "shadow maps");
    pyramid = pass.write(pyramid, base ? Access::imageStore : Access::imageLoadStore,
                         frame::ShaderName(kLevelImages[0]).level(first),
                         base ? "finest levels" : "next levels from the last one");
    for (int level = first + 1; level <= last; ++level)
      pass.also(frame::ShaderName(kLevelImages[static_cast<size_t>(level - first)]).level(level));
    const frame::ProgramHandle program =
        pass.program({.files = {"glsl/shadow/min_max_pyramid.comp.glsl"},
                      .defines = {{"BASE", base ? "1" : "0"}, {"COARSER", std::to_string(last - first)}}});
    if (cacheable) pass.cacheable();
    pass.execute([program, last, desc](frame::PassContext& context) {
      context.use(program);
      context.dispatch(std::max(desc.width >> last, 1), std::max(desc.height >> last, 1), desc.layers, 8, 8);
    });
  } while (last < desc.levels - 1);
  return pyramid;
}

/// Level 0 from the shadow maps, level 1 from that, and the others, of which each has more to read the more
/// levels lie between, up to three at once: most of the work is in the first two.
TextureHandle addMinMaxWindows(frame::FrameGraph& graph, TextureHandle source, bool cacheable) {
  constexpr std::string_view name = "min-max windows";
  const gpu::TextureDesc& maps = graph.desc(source);
  const gpu::TextureDesc desc = derivedDesc(graph, source, name, GL_RG32F,
                                            glsl::min_max_windows_levels(std::max(maps.width, maps.height)));
  TextureHandle windows = graph.createTexture(name, desc);
  int first = 0, last = 0;  // levels of a pass
  do {
    const bool base = first == 0;
    last = first < 2 ? first : std::min(first + 2, desc.levels - 1);
    frame::PassBuilder pass = graph.addPass(passName(name, first, last), "shadow");
    pass.role(frame::PassRole::filter);
    if (base) pass.read(source, Access::sampled, "depth", "shadow maps");
    windows = pass.write(windows, base ? Access::imageStore : Access::imageLoadStore,
                         frame::ShaderName(kLevelImages[0]).level(base ? 0 : first - 1),
                         base ? "finest level" : "next levels from the one before");
    int rows = base ? desc.height : 0;  // of texels: levels lie below each other, each in whole work groups
    for (int level = first; level <= last && !base; ++level) {
      pass.also(frame::ShaderName(kLevelImages[static_cast<size_t>(level - first) + 1]).level(level));
      rows += 8 * ((std::max(desc.height >> level, 1) + 7) / 8);
    }
    const frame::ProgramHandle program = pass.program(
        {.files = {"glsl/shadow/min_max_windows.comp.glsl"},
         .defines = {{"BASE", base ? "1" : "0"}, {"COARSER", std::to_string(base ? 0 : last - first + 1)}}});
    if (cacheable) pass.cacheable();
    pass.execute([program, first, rows, desc](frame::PassContext& context) {
      context.use(program);
      context.dispatch(std::max(desc.width >> first, 1), rows, desc.layers, 8, 8);
    });
    first = last + 1;
  } while (first < desc.levels);
  return windows;
}

/// As addMinMaxWindows(), but the levels are layers, since each is as large as the source.
TextureHandle addNBuffer(frame::FrameGraph& graph, TextureHandle source, bool cacheable, int mostLayers) {
  constexpr std::string_view name = "N-buffer";
  const gpu::TextureDesc& maps = graph.desc(source);
  const int levels = glsl::n_buffer_levels(std::max(maps.width, maps.height));
  const gpu::TextureDesc desc = derivedDesc(graph, source, name, GL_RG32F, 1, levels);
  if (desc.layers > mostLayers)
    throw UsageError(
        fmt::format("{} of {} layers: the device has at most {} in one array; ask for fewer "
                    "lights at once",
                    name, desc.layers, mostLayers));
  TextureHandle windows = graph.createTexture(name, desc);
  for (int level = 0; level < levels; ++level) {
    frame::PassBuilder pass = graph.addPass(fmt::format("{} level {}", name, level), "shadow");
    pass.role(frame::PassRole::filter);
    if (level == 0) pass.read(source, Access::sampled, "depth", "shadow maps");
    windows = pass.write(windows, level == 0 ? Access::imageStore : Access::imageLoadStore, "windows",
                         level == 0 ? "windows of one texel" : "windows twice as wide as before");
    const frame::ProgramHandle program = pass.program(
        {.files = {"glsl/shadow/n_buffer.comp.glsl"}, .defines = {{"BASE", level == 0 ? "1" : "0"}}});
    if (cacheable) pass.cacheable();
    pass.execute([program, level, desc, layers = desc.layers / levels](frame::PassContext& context) {
      gpu::Program& kernel = context.use(program);
      if (level > 0) kernel.set("level", level);
      context.dispatch(desc.width, desc.height, layers, 8, 8);
    });
  }
  return windows;
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

GLenum tableFormat(const SatDesc& desc) {
  const int words = desc.words * (desc.moments == SatMoments::z ? 1 : 2);
  if (words == 1) return GL_R32UI;
  return words == 2 ? GL_RG32UI : GL_RGBA32UI;
}

SummedAreaTable addTable(frame::FrameGraph& graph, TextureHandle source, const SatDesc& desc,
                         bool cacheable) {
  const uint32_t layout =
      glsl::sat_format(static_cast<uint32_t>(desc.bits), static_cast<uint32_t>(desc.words),
                       desc.moments == SatMoments::zAndSquare ? 1 : 0);
  return {addSummedAreaPasses(graph, source, tableFormat(desc),
                              {.name = "summed-area table",
                               .defines = {{"CONTENTS", "0"}, {"TABLE_FORMAT", fmt::format("{}u", layout)}},
                               .shared = desc.method == SatMethod::sharedMemory,
                               .cacheable = cacheable}),
          layout};
}

}  // namespace

struct DerivedMaps::Implementation {
  const gpu::Device& device;
  std::vector<KnownPyramid> pyramids = {};
  std::vector<KnownTexture> windows = {}, nBuffers = {};
  std::vector<KnownTable> tables = {};
  std::vector<KnownMoments> moments = {};
};

DerivedMaps::DerivedMaps(const gpu::Device& device) : implementation_(new Implementation{.device = device}) {}
DerivedMaps::~DerivedMaps() = default;

void DerivedMaps::clear() {
  implementation_->pyramids.clear();
  implementation_->windows.clear();
  implementation_->nBuffers.clear();
  implementation_->tables.clear();
  implementation_->moments.clear();
}

MinMaxPyramid DerivedMaps::minMaxPyramid(frame::FrameGraph& graph, TextureHandle depth, bool cacheable,
                                         int boxSide) {
  Implementation& d = *implementation_;
  const int levels = pyramidLevels(graph.desc(depth), boxSide);
  for (const KnownPyramid& known : d.pyramids) {
    if (known.source == depth && known.pyramid.levels >= levels) return known.pyramid;
  }
  const TextureHandle texture = addMinMaxPyramid(graph, depth, cacheable, levels);
  d.pyramids.push_back({depth, {texture, levels}});
  return d.pyramids.back().pyramid;
}

TextureHandle DerivedMaps::minMaxWindows(frame::FrameGraph& graph, TextureHandle depth, bool cacheable) {
  return knownOr(implementation_->windows, depth, [&] { return addMinMaxWindows(graph, depth, cacheable); });
}

TextureHandle DerivedMaps::nBuffer(frame::FrameGraph& graph, TextureHandle depth, bool cacheable) {
  return knownOr(implementation_->nBuffers, depth, [&] {
    return addNBuffer(graph, depth, cacheable, implementation_->device.limits().maxArrayLayers);
  });
}

SummedAreaTable DerivedMaps::summedAreaTable(frame::FrameGraph& graph, TextureHandle depth, bool cacheable,
                                             const SatDesc& desc) {
  Implementation& d = *implementation_;
  const SatDesc full = resolved(desc, d.device.software());
  for (const KnownTable& known : d.tables) {
    if (known.source == depth && known.desc == full) return known.table;
  }
  d.tables.push_back({depth, full, addTable(graph, depth, full, cacheable)});
  return d.tables.back().table;
}

MomentTable DerivedMaps::momentTable(frame::FrameGraph& graph, TextureHandle depth, bool cacheable,
                                     int bits) {
  Implementation& d = *implementation_;
  const int wanted = bits == 0 ? momentBits(graph.desc(depth).width) : bits;
  for (const KnownMoments& known : d.moments) {
    if (known.source == depth && known.table.bits == wanted) return known.table;
  }
  d.moments.push_back({depth, addMomentTable(graph, depth, cacheable, wanted, !d.device.software())});
  return d.moments.back().table;
}

}  // namespace limn::shadow
