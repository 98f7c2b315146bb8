// What the frame graph itself costs on the CPU: a frame of passes that do nothing, and planning one from
// scratch.
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
