// Which passes are kept, and in which order they run.
#include <fmt/format.h>

#include <algorithm>
#include <queue>
#include <set>

#include "core/base/text.h"
#include "core/frame/private/access.h"
#include "core/frame/private/graph_data.h"

namespace limn::frame {
namespace {

void addUnique(std::vector<std::string>& names, const std::string& name) {
  if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

void checkContentsDefined(const Graph& graph, std::vector<std::string>& problems) {
  const auto undefined = [&](const Resource& r, uint32_t version) { return version == 0 && !r.imported(); };
  for (uint32_t p = 0; p < graph.passes.size(); ++p) {
    for (const ResourceAccess& a : graph.passes[p].accesses) {
      const Resource& r = graph.resources[a.resource];
      const bool reads = !a.write() || isReadModifyWrite(a.access);
      if (reads && undefined(r, a.write() ? a.parent : a.version)) {
        problems.push_back(fmt::format("pass '{}' reads '{}' as {} ({}) before any pass wrote it",
                                       graph.title(p), r.name, name(a.access), a.why));
      }
    }
  }
  for (const Resource& r : graph.resources) {
    for (uint32_t version : r.outputs) {
      if (undefined(r, version)) problems.push_back(fmt::format("output '{}' is written by no pass", r.name));
    }
  }
}

void keepPassesThatContribute(Graph& graph) {
  std::vector<uint32_t> open;
  const auto need = [&](uint32_t pass) {
    if (pass == kNoIndex || graph.passes[pass].kept) return;
    graph.passes[pass].kept = true;
    open.push_back(pass);
  };
  for (const Resource& r : graph.resources) {
    for (uint32_t version : r.outputs) need(r.versions[version].producer);
  }
  for (uint32_t p = 0; p < graph.passes.size(); ++p) {
    if (graph.passes[p].sideEffect) need(p);
  }
  while (!open.empty()) {
    const Pass& pass = graph.passes[open.back()];
    open.pop_back();
    for (const ResourceAccess& a : pass.accesses) {
      const Resource& r = graph.resources[a.resource];
      if (!a.write()) need(r.versions[a.version].producer);
      if (a.write() && isReadModifyWrite(a.access)) need(r.versions[a.parent].producer);
    }
  }
}

/// The passes that use what `pass` wrote into this version.
std::vector<uint32_t> consumers(const Graph& graph, const Resource& r, uint32_t version) {
  std::vector<uint32_t> passes = r.versions[version].readers;
  const uint32_t next = r.versions[version].overwriter;
  if (next != kNoIndex) {
    const uint32_t writer = r.versions[next].producer;
    for (const ResourceAccess& a : graph.passes[writer].accesses) {
      if (&graph.resources[a.resource] == &r && a.version == next && a.write() &&
          isReadModifyWrite(a.access)) {
        passes.push_back(writer);
      }
    }
  }
  return passes;
}

std::string whyLeftOut(const Graph& graph, uint32_t pass) {
  std::vector<std::string> unread, users;
  for (const ResourceAccess& a : graph.passes[pass].accesses) {
    if (!a.write()) continue;
    addUnique(unread, graph.resources[a.resource].name);
    for (uint32_t user : consumers(graph, graph.resources[a.resource], a.version)) {
      if (user != pass) addUnique(users, graph.title(user));
    }
  }
  if (!users.empty()) {
    return fmt::format("only feeds {}, which {} left out", joined(users), users.size() == 1 ? "is" : "are");
  }
  if (unread.empty()) return "writes nothing";
  return "nothing reads " + joined(unread);
}

/// Before -> after, among kept passes.
using Edges = std::vector<std::set<uint32_t>>;

void addEdge(const Graph& graph, Edges& edges, uint32_t before, uint32_t after) {
  if (before == kNoIndex || before == after || !graph.passes[before].kept) return;
  edges[before].insert(after);
}

Edges dependencies(const Graph& graph) {
  Edges edges(graph.passes.size());
  for (uint32_t p = 0; p < graph.passes.size(); ++p) {
    if (!graph.passes[p].kept) continue;
    for (const ResourceAccess& a : graph.passes[p].accesses) {
      const auto& versions = graph.resources[a.resource].versions;
      if (!a.write()) {
        addEdge(graph, edges, versions[a.version].producer, p);
        continue;
      }
      // After the writer and the readers of the contents it replaces. Where that writer is left out, after
      // those of the contents before.
      for (uint32_t v = a.parent; v != kNoIndex; v = versions[v].parent) {
        for (uint32_t reader : versions[v].readers) addEdge(graph, edges, reader, p);
        addEdge(graph, edges, versions[v].producer, p);
        if (versions[v].producer != kNoIndex && graph.passes[versions[v].producer].kept) break;
      }
    }
  }
  return edges;
}

void sortTopologically(Graph& graph, std::vector<std::string>& problems) {
  const Edges edges = dependencies(graph);
  std::vector<uint32_t> waitsFor(graph.passes.size(), 0);
  for (const auto& after : edges) {
    for (uint32_t p : after) ++waitsFor[p];
  }
  std::priority_queue<uint32_t, std::vector<uint32_t>, std::greater<>> ready;
  size_t kept = 0;
  for (uint32_t p = 0; p < graph.passes.size(); ++p) {
    kept += graph.passes[p].kept;
    if (graph.passes[p].kept && waitsFor[p] == 0) ready.push(p);
  }
  graph.order.clear();
  while (!ready.empty()) {
    const uint32_t p = ready.top();
    ready.pop();
    graph.order.push_back(p);
    for (uint32_t next : edges[p]) {
      if (--waitsFor[next] == 0) ready.push(next);
    }
  }
  if (graph.order.size() == kept) return;
  std::vector<std::string> stuck;
  for (uint32_t p = 0; p < graph.passes.size(); ++p) {
    if (graph.passes[p].kept && waitsFor[p] > 0) stuck.push_back(fmt::format("'{}'", graph.title(p)));
  }
  problems.push_back(fmt::format(
      "no order satisfies passes {}: one reads contents that another overwrites earlier", joined(stuck)));
}

void checkOutputsSurvive(const Graph& graph, std::vector<std::string>& problems) {
  for (const Resource& r : graph.resources) {
    for (uint32_t version : r.outputs) {
      for (uint32_t v = r.versions[version].overwriter; v != kNoIndex; v = r.versions[v].overwriter) {
        if (!graph.passes[r.versions[v].producer].kept) continue;
        problems.push_back(fmt::format("output '{}' (version {}) is overwritten by pass '{}'", r.name,
                                       version, graph.title(r.versions[v].producer)));
        break;
      }
    }
  }
}

}  // namespace

void cullAndOrder(Graph& graph, std::vector<std::string>& problems) {
  for (Pass& pass : graph.passes) {
    pass.kept = false;
    pass.reason.clear();
    pass.barriers = 0;
  }
  checkContentsDefined(graph, problems);
  keepPassesThatContribute(graph);
  for (uint32_t p = 0; p < graph.passes.size(); ++p) {
    if (!graph.passes[p].kept) graph.passes[p].reason = whyLeftOut(graph, p);
  }
  sortTopologically(graph, problems);
  checkOutputsSurvive(graph, problems);
}

}  // namespace limn::frame
