#include <fmt/format.h>

#include "core/base/error.h"
#include "core/frame/private/graph_data.h"

namespace limn::frame {

void FrameGraph::plan() {
  Graph& graph = *implementation_;
  if (graph.planned) return;
  graph.release();
  std::vector<std::string> problems = graph.problems;
  cullAndOrder(graph, problems);
  if (!problems.empty()) {
    if (problems.size() == 1) throw Error("frame graph: " + problems.front());
    std::string message = fmt::format("frame graph: {} problems:", problems.size());
    for (size_t i = 0; i < problems.size(); ++i) message += fmt::format(" ({}) {};", i + 1, problems[i]);
    message.pop_back();
    throw Error(message);
  }
  assignMemory(graph);
  deriveBarriers(graph);
  planCache(graph);
  graph.planned = true;
}

int64_t FrameGraph::transientBytes() const {
  int64_t bytes = 0;
  for (const Physical& p : implementation_->physicals) bytes += p.bytes;
  return bytes;
}

int64_t FrameGraph::transientBytesUnaliased() const {
  int64_t bytes = 0;
  for (const Resource& r : implementation_->resources) {
    if (r.first != kNoIndex) bytes += resourceBytes(r);
  }
  return bytes;
}

GLbitfield FrameGraph::finalBarriers() const {
  return implementation_->finalBarriers;
}

}  // namespace limn::frame
