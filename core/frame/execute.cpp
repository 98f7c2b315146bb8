#include <fmt/format.h>

#include <chrono>

#include "core/base/error.h"
#include "core/base/foreign_exception.h"
#include "core/base/whereabouts.h"
#include "core/frame/private/graph_data.h"

namespace limn::frame {
namespace {

/// The state PassContext promises.
void setBaseline(const gl::Functions& gl) {
  gl.UseProgram(0);
  gl.BindFramebuffer(GL_FRAMEBUFFER, 0);
  gl.BindVertexArray(0);
  gl.Disable(GL_DEPTH_TEST);
  gl.Disable(GL_BLEND);
  gl.Disable(GL_CULL_FACE);
  gl.Disable(GL_SCISSOR_TEST);
  gl.Disable(GL_STENCIL_TEST);
  gl.Disable(GL_POLYGON_OFFSET_FILL);
  gl.DepthFunc(GL_LESS);
  gl.DepthMask(GL_TRUE);
  gl.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  gl.BlendEquation(GL_FUNC_ADD);
  gl.BlendFunc(GL_ONE, GL_ZERO);
  gl.CullFace(GL_BACK);
}

class DebugGroup {
 public:
  DebugGroup(const gl::Functions& gl, const std::string& name) : gl_(gl) {
    gl_.PushDebugGroup(GL_DEBUG_SOURCE_APPLICATION, 0, static_cast<GLsizei>(name.size()), name.data());
  }
  ~DebugGroup() { gl_.PopDebugGroup(); }
  DebugGroup(const DebugGroup&) = delete;
  DebugGroup& operator=(const DebugGroup&) = delete;

 private:
  const gl::Functions& gl_;
};

class PassTimer {
 public:
  PassTimer(Graph& graph, Pass& pass, Timing timing) : graph_(graph), pass_(pass), timing_(timing) {
    if (timing_ == Timing::query) {
      gpu::Query& query = pass_.queries[graph_.querySet];
      if (!query) query = gpu::Query(*graph_.device, GL_TIME_ELAPSED);
      query.begin();
    }
    if (timing_ == Timing::finish) {
      graph_.device->gl().Finish();
      start_ = std::chrono::steady_clock::now();
    }
  }
  ~PassTimer() {
    pass_.timed |= timing_ != Timing::off;
    if (timing_ == Timing::query) pass_.queries[graph_.querySet].end();
    if (timing_ == Timing::finish) {
      graph_.device->gl().Finish();
      const std::chrono::duration<double, std::milli> elapsed = std::chrono::steady_clock::now() - start_;
      pass_.milliseconds = elapsed.count();
    }
  }
  PassTimer(const PassTimer&) = delete;
  PassTimer& operator=(const PassTimer&) = delete;

 private:
  Graph& graph_;
  Pass& pass_;
  Timing timing_;
  std::chrono::steady_clock::time_point start_;
};

void runPass(Graph& graph, uint32_t index, GLbitfield barriers, Timing timing, PassContext& context) {
  const gl::Functions& gl = graph.device->gl();
  Pass& pass = graph.passes[index];
  const DebugGroup group(gl, pass.name);
  const PassTimer timer(graph, pass, timing);
  if (barriers != 0) gl.MemoryBarrier(barriers);
  setBaseline(gl);
  graph.current = index;
  graph.program = kNoIndex;
  const Whereabouts here(pass.technique.c_str(), pass.name.c_str());
  try {
    pass.function(context);
  } catch (...) {
    rethrowAsError(fmt::format("pass {}", graph.title(index)));
  }
}

/// A pass that was to run and did not has nothing to be kept; passes that write to the same resources or read
/// its results follow from that in the next frame (decideRuns).
void forgetFrom(Graph& graph, size_t position) {
  for (size_t i = position; i < graph.order.size(); ++i) {
    Pass& pass = graph.passes[graph.order[i]];
    if (pass.run) pass.valid = false;
  }
}

/// False if it was cancelled.
bool executePasses(Graph& graph, Timing timing, const FrameGraph::Cancelled& cancelled,
                   PassContext& context) {
  // Before the first frame the memory may have been written by shaders of another graph.
  GLbitfield barriers = graph.firstFrame ? GL_ALL_BARRIER_BITS : 0;
  graph.firstFrame = false;
  for (size_t i = 0; i < graph.order.size(); ++i) {
    Pass& pass = graph.passes[graph.order[i]];
    pass.triangles = 0;
    for (const uint32_t program : pass.programs) graph.programs[program].dispatches = 0;
    barriers |= pass.barriers;  // those of a pass that is skipped are left to the next that runs
    if (!pass.run) continue;
    if (cancelled && cancelled()) {
      forgetFrom(graph, i);
      graph.device->gl().MemoryBarrier(GL_ALL_BARRIER_BITS);  // the next frame begins anywhere
      return false;
    }
    runPass(graph, graph.order[i], barriers, timing, context);
    noteRun(graph, pass);
    barriers = 0;
  }
  barriers |= graph.finalBarriers;
  if (barriers != 0) graph.device->gl().MemoryBarrier(barriers);
  return true;
}

}  // namespace

std::string_view name(Timing timing) {
  switch (timing) {
    case Timing::off:
      return "off";
    case Timing::query:
      return "query";
    case Timing::finish:
      return "finish";
  }
  return "unknown";
}

Timing preferredTiming(const gpu::Device& device) {
  return device.software() ? Timing::finish : Timing::query;
}

bool FrameGraph::execute(Timing timing, const Cancelled& cancelled) {
  Graph& graph = *implementation_;
  if (!graph.planned || graph.device == nullptr) {
    throw Error("frame graph: executed before prepare(), or declared further since");
  }
  if (graph.order.empty()) return true;
  decideRuns(graph);
  if (timing != Timing::off) {
    graph.lastTiming = timing;
    graph.querySet = 1 - graph.querySet;  // the other set's results may still be on their way
    for (uint32_t p : graph.order) graph.passes[p].timed = false;
  }
  PassContext context(*this);
  bool whole = false;
  try {
    whole = executePasses(graph, timing, cancelled, context);
  } catch (...) {
    graph.current = kNoIndex;
    invalidate();
    graph.device->gl().MemoryBarrier(GL_ALL_BARRIER_BITS);  // the next frame begins anywhere
    setBaseline(graph.device->gl());
    throw;
  }
  graph.current = kNoIndex;
  setBaseline(graph.device->gl());
  return whole;
}

void FrameGraph::invalidate() {
  for (Pass& pass : implementation_->passes) pass.valid = false;
}

std::vector<PassTime> FrameGraph::passTimes() {
  Graph& graph = *implementation_;
  std::vector<PassTime> times;
  if (graph.lastTiming == Timing::off) return times;
  for (uint32_t p : graph.order) {
    Pass& pass = graph.passes[p];
    if (!pass.timed) continue;
    if (graph.lastTiming == Timing::query) {
      pass.milliseconds = static_cast<double>(pass.queries[graph.querySet].result()) * 1e-6;
    }
    times.push_back({pass.name, pass.technique, pass.role, pass.milliseconds});
  }
  return times;
}

}  // namespace limn::frame
