#include "core/shadow/fourier_maps.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "core/base/error.h"
#include "core/shadow/private/map_memory.h"
#include "core/shadow/private/summed_area_passes.h"
#include "glsl/shadow/fourier_shadow.glsl"

namespace limn::shadow {
namespace {

using frame::Access;

constexpr int kChunk = 2;  // groups that a thread sums at once

struct Formats {
  GLenum basis, depthBasis, depth;
};

Formats formatsOf(FourierFilter filter) {
  if (filter == FourierFilter::sat) return {GL_RGBA32I, GL_RGBA32I, GL_R32I};
  return {GL_RGBA8_SNORM, GL_RGBA16_SNORM, GL_R16};
}

/// The three textures, created in the graph.
void createTextures(frame::FrameGraph& graph, const gpu::Device& device, frame::TextureHandle source,
                    FourierMaps& maps) {
  gpu::TextureDesc desc = graph.desc(source);
  if (desc.target != GL_TEXTURE_2D_ARRAY || desc.format != GL_R32F)
    throw Error("Fourier maps: the source is not an R32F array texture");
  const Formats formats = formatsOf(maps.desc.filter);
  const int views = desc.layers, most = device.limits().maxArrayLayers;
  if (views * maps.groups() > most) {
    throw UsageError(fmt::format(
        "Fourier maps of order {} of {} shadow maps take {} layers, more than the {} that the device "
        "has; ask for a smaller order or fewer lights at once",
        maps.desc.order, views, views * maps.groups(), most));
  }
  desc.levels = maps.desc.filter == FourierFilter::sat ? 1 : 0;
  int64_t bytes = 0;
  const auto create = [&](std::string_view name, GLenum format, int layers) {
    desc.format = format;
    desc.layers = layers;
    bytes += gpu::textureBytes(desc);
    return graph.createTexture(name, gpu::resolved(desc));
  };
  maps.basis = create("Fourier basis", formats.basis, views * maps.groups());
  maps.depthBasis = create("Fourier basis times depth", formats.depthBasis, views * maps.groups());
  maps.depth = create("Fourier depth", formats.depth, views);
  if (bytes > kMemoryLimit) {
    throw UsageError(
        fmt::format("Fourier maps of order {} of {} shadow maps of {} x {} texels take {} MiB, more than the "
                    "{} MiB that they may; "
                    "ask for a smaller shadow_map_size, a smaller order, mip maps or fewer lights at once",
                    maps.desc.order, views, desc.width, desc.height, bytes >> 20, kMemoryLimit >> 20));
  }
}

/// Which depths each map's series spans.
frame::BufferHandle addRanges(frame::FrameGraph& graph, const MinMaxPyramid& pyramid, bool cacheable,
                              const FourierMaps& maps) {
  const gpu::TextureDesc desc = graph.desc(pyramid.texture);
  int level = 0;
  while (level + 1 < pyramid.levels && std::max(desc.width, desc.height) >> level > 128) ++level;
  frame::BufferHandle ranges =
      graph.createBuffer("Fourier ranges", {static_cast<size_t>(desc.layers) * sizeof(glsl::FourierRange)});
  frame::PassBuilder pass = graph.addPass("Fourier ranges", "shadow");
  pass.role(frame::PassRole::filter);
  const bool fitted = maps.desc.fit != FourierFit::map;
  if (fitted) pass.read(pyramid.texture, Access::sampled, "pyramid", "depths that are there");
  ranges = pass.write(ranges, Access::storageStore, "Ranges", "depths that the series spans");
  const frame::ProgramHandle program =
      pass.program({.files = {"glsl/shadow/fourier_range.comp.glsl"},
                    .defines = {{"FIT", std::to_string(static_cast<int>(maps.desc.fit))}}});
  if (cacheable) pass.cacheable();
  pass.execute([=, span = static_cast<float>(maps.constants.range)](frame::PassContext& context) {
    gpu::Program& kernel = context.use(program);
    kernel.set("span", span);
    if (fitted) kernel.set("level", level);
    context.dispatch(desc.layers, 1, 1, 1, 1);
  });
  return ranges;
}

void addMips(frame::FrameGraph& graph, frame::TextureHandle source, bool cacheable, FourierMaps& maps) {
  const gpu::TextureDesc desc = graph.desc(maps.depth);
  for (int level = 0; level < desc.levels; ++level) {
    const bool base = level == 0;
    frame::PassBuilder pass = graph.addPass(fmt::format("Fourier basis level {}", level), "shadow");
    pass.role(frame::PassRole::filter);
    if (base) {
      pass.read(source, Access::sampled, "depth", "shadow maps")
          .read(maps.ranges, Access::storageLoad, "Ranges", "depths that the series spans");
    }
    const Access access = base ? Access::imageStore : Access::imageLoadStore;
    const std::string_view why = base ? "finest level" : "next level from the one before";
    const auto write = [&](frame::TextureHandle& image, const char* coarser, const char* finer) {
      image = pass.write(image, access, frame::ShaderName(coarser).level(level), why);
      if (!base) pass.also(frame::ShaderName(finer).level(level - 1));
    };
    write(maps.basis, "coarser_basis", "finer_basis");
    write(maps.depthBasis, "coarser_depth_basis", "finer_depth_basis");
    write(maps.depth, "coarser_depth", "finer_depth");
    const auto even = [&](int size) { return size >> level > 0 && ((size >> (level - 1)) & 1) == 0; };
    const bool halved = !base && even(desc.width) && even(desc.height);
    const frame::ProgramHandle program =
        pass.program({.files = {"glsl/shadow/fourier_mips.comp.glsl"},
                      .defines = {{"BASE", base ? "1" : "0"},
                                  {"HALVED", halved ? "1" : "0"},
                                  {"GROUPS", std::to_string(maps.groups())}}});
    if (cacheable) pass.cacheable();
    pass.execute([=, span = static_cast<float>(maps.constants.range)](frame::PassContext& context) {
      gpu::Program& kernel = context.use(program);
      if (base) kernel.set("span", span);
      context.dispatch(std::max(desc.width >> level, 1), std::max(desc.height >> level, 1), desc.layers, 8,
                       8);
    });
  }
}

void addRows(frame::FrameGraph& graph, frame::TextureHandle source, bool cacheable, bool shared,
             FourierMaps& maps) {
  const gpu::TextureDesc desc = graph.desc(maps.depth);
  frame::PassBuilder pass = graph.addPass("Fourier sums rows", "shadow");
  pass.role(frame::PassRole::filter);
  pass.read(source, Access::sampled, "depth", "shadow maps")
      .read(maps.ranges, Access::storageLoad, "Ranges", "depths that the series spans");
  maps.basis = pass.write(maps.basis, Access::imageStore, "basis", "sums along rows");
  maps.depthBasis = pass.write(maps.depthBasis, Access::imageStore, "depth_basis", "sums along rows");
  maps.depth = pass.write(maps.depth, Access::imageStore, "plain_depth", "sums along rows");
  const int groups = maps.groups(), perThread = std::min(groups, kChunk);
  const frame::ProgramHandle program = pass.program({.files = {"glsl/shadow/fourier_rows.comp.glsl"},
                                                     .defines = {{"SHARED", shared ? "1" : "0"},
                                                                 {"GROUPS", std::to_string(groups)},
                                                                 {"CHUNK", std::to_string(perThread)}}});
  if (cacheable) pass.cacheable();
  pass.execute([=, span = static_cast<float>(maps.constants.range)](frame::PassContext& context) {
    context.use(program).set("span", span);
    const int chunks = (groups + perThread - 1) / perThread;
    context.dispatch(lineGroups(desc.height, shared, false), 1, desc.layers * chunks, 1, 1);
  });
}

}  // namespace

std::map<std::string, std::string> FourierMaps::defines() const {
  std::string weights;
  for (int k = 1; k <= 2 * groups(); ++k) {
    weights += fmt::format("{}{:.9e}", k > 1 ? ", " : "",
                           glsl::fourier_weight(k, desc.order, static_cast<glsl::uint>(desc.window)));
  }
  return {{"FOURIER_GROUPS", std::to_string(groups())},
          {"FOURIER_WEIGHTS", weights},
          {"FOURIER_SAT", desc.filter == FourierFilter::sat ? "1" : "0"},
          {"FOURIER_DELTA", fmt::format("{:.9e}", constants.delta)},
          {"FOURIER_RANGE", fmt::format("{:.9e}", constants.range)},
          {"FOURIER_LEVEL", fmt::format("{:.9e}", constants.level)},
          {"FOURIER_VALLEY", fmt::format("{:.9e}", constants.valley)},
          {"FOURIER_CURVATURE", fmt::format("{:.9e}", constants.curvature)},
          {"FOURIER_TOLERANCE", fmt::format("{:.9e}", constants.tolerance)},
          {"FOURIER_NOISE", fmt::format("{:.9e}", noise)}};
}

void FourierMaps::declare(frame::PassBuilder& pass) const {
  const auto sampled = [&](const char* name) { return frame::ShaderName(name).sampledWith(trilinear); };
  pass.read(depthBasis, Access::sampled, sampled("fourier_depth_basis_maps"), "stage 1: mean blocker depth")
      .read(depth, Access::sampled, sampled("fourier_depth_maps"), "stage 1: its constant term")
      .read(basis, Access::sampled, sampled("fourier_basis_maps"),
            "stage 2: its normalisation; stage 3: visibility")
      .read(ranges, Access::storageLoad, "FourierRanges", "depths that the series spans");
}

FourierMaps addFourierMaps(frame::FrameGraph& graph, const gpu::Device& device, frame::TextureHandle depth,
                           const MinMaxPyramid& pyramid, bool cacheable, FourierDesc desc) {
  if (desc.method == SatMethod::automatic)
    desc.method = device.software() ? SatMethod::rowParallel : SatMethod::sharedMemory;
  FourierMaps maps{.desc = desc, .constants = fourierConstants(desc.order, desc.window)};
  const gpu::TextureDesc source = graph.desc(depth);
  const bool sums = desc.filter == FourierFilter::sat;
  maps.noise = fourierNoise(desc.order, desc.window,
                            sums ? glsl::fourier_sum_scale(source.width * source.height) : 127);
  createTextures(graph, device, depth, maps);
  maps.ranges = addRanges(graph, pyramid, cacheable, maps);
  const bool shared = desc.method == SatMethod::sharedMemory;
  if (sums) {
    addRows(graph, depth, cacheable, shared, maps);
    addColumnSums(
        graph, {&maps.basis, &maps.depthBasis, &maps.depth},
        {.name = "Fourier sums", .defines = {{"CONTENTS", "2"}}, .shared = shared, .cacheable = cacheable});
  } else {
    addMips(graph, depth, cacheable, maps);
  }
  return maps;
}

}  // namespace limn::shadow
