// Which transient resources share memory.
#include <algorithm>
#include <bit>

#include "core/frame/private/access.h"
#include "core/frame/private/graph_data.h"

namespace limn::frame {
namespace {

void findLifetimes(Graph& graph) {
  for (Resource& r : graph.resources) {
    r.first = r.last = r.physical = kNoIndex;
    r.persistent = false;
  }
  for (uint32_t position = 0; position < graph.order.size(); ++position) {
    const Pass& pass = graph.passes[graph.order[position]];
    for (const ResourceAccess& a : pass.accesses) {
      Resource& r = graph.resources[a.resource];
      r.first = std::min(r.first, position);
      r.last = position;
      r.persistent |= pass.cacheable && a.write();
    }
  }
  // An output is still wanted when the frame is over.
  for (Resource& r : graph.resources) {
    if (!r.outputs.empty() && r.first != kNoIndex) r.last = kNoIndex;
  }
}

bool sameKind(const Physical& p, const Resource& r) {
  if (p.texture != r.texture) return false;
  return r.texture ? p.textureDesc == r.textureDesc : p.bufferBytes == bufferSizeClass(r.bufferDesc.bytes);
}

void place(Graph& graph, uint32_t index) {
  Resource& r = graph.resources[index];
  if (!r.persistent) {
    for (uint32_t i = 0; i < graph.physicals.size(); ++i) {
      Physical& p = graph.physicals[i];
      if (p.persistent || !sameKind(p, r) || p.last >= r.first) continue;
      r.physical = i;
      p.last = r.last;
      p.resources.push_back(index);
      return;
    }
  }
  r.physical = static_cast<uint32_t>(graph.physicals.size());
  graph.physicals.push_back({r.texture,
                             r.textureDesc,
                             r.texture ? 0 : bufferSizeClass(r.bufferDesc.bytes),
                             resourceBytes(r),
                             r.persistent,
                             r.last,
                             {index}});
}

}  // namespace

size_t bufferSizeClass(size_t bytes) {
  constexpr size_t smallest = 256;
  if (bytes <= smallest) return smallest;
  const size_t step = std::bit_floor(bytes) / 8;
  return (bytes + step - 1) / step * step;
}

int64_t resourceBytes(const Resource& r) {
  if (r.imported()) return 0;
  return r.texture ? gpu::textureBytes(r.textureDesc)
                   : static_cast<int64_t>(bufferSizeClass(r.bufferDesc.bytes));
}

void assignMemory(Graph& graph) {
  graph.physicals.clear();
  findLifetimes(graph);
  std::vector<uint32_t> used;
  for (uint32_t i = 0; i < graph.resources.size(); ++i) {
    if (graph.resources[i].first != kNoIndex && !graph.resources[i].imported()) used.push_back(i);
  }
  std::stable_sort(used.begin(), used.end(), [&](uint32_t a, uint32_t b) {
    return graph.resources[a].first < graph.resources[b].first;
  });
  for (uint32_t i : used) place(graph, i);
}

}  // namespace limn::frame
