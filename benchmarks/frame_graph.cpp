// What the frame graph itself costs on the CPU: a frame of passes that do nothing, one of passes that bind
// what a program reads and writes, and planning one from scratch.
#include "core/frame/frame_graph.h"

#include <benchmark/benchmark.h>

#include "core/context/context.h"

namespace {

using namespace limn;

/// A chain of `passes` empty passes over small textures.
void declareChain(frame::FrameGraph& graph, int passes) {
  frame::TextureHandle previous;
  for (int i = 0; i < passes; ++i) {
    const frame::TextureHandle made =
        graph.createTexture("t" + std::to_string(i), {.format = GL_RGBA8, .width = 16, .height = 16});
    frame::PassBuilder pass = graph.addPass("pass " + std::to_string(i));
    if (previous) pass.read(previous, frame::Access::sampled, "input");
    previous = pass.write(made, frame::Access::imageStore, "output");
    pass.execute([](frame::PassContext&) {});
  }
  graph.output(previous);
}

void executeFrame(benchmark::State& state) {
  const auto context = Context::create({});
  gpu::Device device(*context);
  gpu::ShaderLibrary shaders(device);
  frame::ResourcePool pool(device);
  frame::FrameGraph graph;
  declareChain(graph, static_cast<int>(state.range(0)));
  graph.prepare(device, shaders, pool);
  for (auto _ : state) graph.execute();
  state.SetLabel(context->info().renderer);
}
BENCHMARK(executeFrame)->Arg(10)->Arg(100)->Unit(benchmark::kMicrosecond);

constexpr gpu::EmbeddedSource kSources[] = {
    {"sum.comp.glsl",
     "layout(local_size_x = 1) in;\n"
     "layout(std430) readonly buffer First { float first[]; };\n"
     "layout(std430) readonly buffer Second { float second[]; };\n"
     "layout(rgba8) writeonly uniform image2D target;\n"
     "uniform sampler2D a;\n"
     "uniform sampler2D b;\n"
     "void main() {\n"
     "  ivec2 p = ivec2(gl_GlobalInvocationID.xy);\n"
     "  imageStore(target, p, texelFetch(a, p, 0) + texelFetch(b, p, 0) + first[p.x] + second[p.x]);\n"
     "}\n"}};

/// A chain of `passes` passes that bind two textures, an image and two buffers to a program, and draw
/// nothing.
void bindFrame(benchmark::State& state) {
  const auto context = Context::create({});
  gpu::Device device(*context);
  gpu::ShaderLibrary shaders(device);
  shaders.mount("techniques/benchmark/", kSources);
  frame::ResourcePool pool(device);
  frame::FrameGraph graph;
  using frame::Access;
  const gpu::TextureDesc desc{.format = GL_RGBA8, .width = 16, .height = 16};
  const gpu::Texture first(device, "first", desc);
  const gpu::Buffer numbers(device, "numbers", 64), others(device, "others", 64);
  const frame::BufferHandle buffers[] = {graph.importBuffer("numbers", numbers),
                                         graph.importBuffer("others", others)};
  const frame::TextureHandle start = graph.importTexture("first", first);
  frame::TextureHandle previous = start;
  for (int64_t i = 0; i < state.range(0); ++i) {
    frame::PassBuilder pass = graph.addPass("pass");
    pass.read(start, Access::sampled, "a", "input")
        .read(previous, Access::sampled, "b", "input")
        .read(buffers[0], Access::storageLoad, "First", "input")
        .read(buffers[1], Access::storageLoad, "Second", "input");
    previous = pass.write(graph.createTexture("t", desc), Access::imageStore, "target", "output");
    const frame::ProgramHandle program = pass.program({{"techniques/benchmark/sum.comp.glsl"}, {}});
    pass.execute([program](frame::PassContext& bound) { bound.use(program); });
  }
  graph.output(previous);
  graph.prepare(device, shaders, pool);
  for (auto _ : state) graph.execute();
  state.SetLabel(context->info().renderer);
}
BENCHMARK(bindFrame)->Arg(10)->Arg(100)->Unit(benchmark::kMicrosecond);

void planFrame(benchmark::State& state) {
  for (auto _ : state) {
    frame::FrameGraph graph;
    declareChain(graph, static_cast<int>(state.range(0)));
    graph.plan();
  }
}
BENCHMARK(planFrame)->Arg(10)->Arg(100)->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
