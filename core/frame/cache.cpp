// Which passes may be skipped because their results are still there.
//
// A cacheable pass runs again when an imported resource it uses was touched, when one of its programs was
// reloaded, when a pass that it reads from runs, or when its results were destroyed: a resource that is
// written several times a frame holds only the last contents, so its writers run all together or not at all.
#include <algorithm>

#include "core/frame/private/access.h"
#include "core/frame/private/graph_data.h"

namespace limn::frame {
namespace {

void addUnique(std::vector<uint32_t>& list, uint32_t value) {
  if (std::find(list.begin(), list.end(), value) == list.end()) list.push_back(value);
}

GLuint importedId(const Resource& r) {
  return r.importedTexture ? r.importedTexture->id() : r.importedBuffer->id();
}

/// `but`: a pass that does not count.
bool keptWriterAbove(const Graph& graph, const Resource& r, uint32_t version, uint32_t but = kNoIndex) {
  for (uint32_t v = r.versions[version].overwriter; v != kNoIndex; v = r.versions[v].overwriter) {
    if (r.versions[v].producer != but && graph.passes[r.versions[v].producer].kept) return true;
  }
  return false;
}

void planPass(const Graph& graph, uint32_t index, Pass& pass) {
  pass.inputs.clear();
  pass.imports.clear();
  pass.alwaysRun = !pass.cacheable || pass.sideEffect;
  for (const ResourceAccess& a : pass.accesses) {
    const Resource& r = graph.resources[a.resource];
    if (r.imported()) pass.imports.push_back({a.resource, 0, 0});
    if (a.write() && !isReadModifyWrite(a.access)) continue;
    const uint32_t version = a.write() ? a.parent : a.version;
    const uint32_t producer = r.versions[version].producer;
    if (producer == index) continue;
    if (producer != kNoIndex) {
      addUnique(pass.inputs, producer);
    } else if (keptWriterAbove(graph, r, version, a.write() ? kNoIndex : index)) {
      // The frame itself changes what this pass reads first. (A pass that reads one part and writes another
      // does not.)
      pass.alwaysRun = true;
    }
  }
}

WriteChain chainOf(const Graph& graph, const Resource& r) {
  WriteChain chain;
  for (uint32_t v = 1; v < r.versions.size(); ++v) {
    if (graph.passes[r.versions[v].producer].kept) addUnique(chain.writers, r.versions[v].producer);
  }
  for (uint32_t v = 0; v < r.versions.size(); ++v) {
    if (!keptWriterAbove(graph, r, v)) continue;
    for (uint32_t reader : r.versions[v].readers) {
      if (graph.passes[reader].kept) addUnique(chain.earlyReaders, reader);
    }
  }
  return chain;
}

bool importsChanged(const Graph& graph, const Pass& pass) {
  return std::any_of(pass.imports.begin(), pass.imports.end(), [&](const ImportSeen& seen) {
    const Resource& r = graph.resources[seen.resource];
    return seen.revision != r.revision || seen.id != importedId(r);
  });
}

/// Whether shaders were reloaded since the pass ran, whoever had them reloaded: graphs share programs.
bool programsChanged(const Graph& graph, const Pass& pass) {
  return std::any_of(pass.programs.begin(), pass.programs.end(), [&](uint32_t index) {
    const ProgramUse& use = graph.programs[index];
    return use.ranWith != use.program->serial();
  });
}

}  // namespace

void planCache(Graph& graph) {
  for (uint32_t p : graph.order) planPass(graph, p, graph.passes[p]);
  graph.chains.clear();
  for (const Resource& r : graph.resources) {
    WriteChain chain = chainOf(graph, r);
    if (chain.writers.size() > 1) graph.chains.push_back(std::move(chain));
  }
}

void decideRuns(Graph& graph) {
  const auto runs = [&](uint32_t p) { return graph.passes[p].kept && graph.passes[p].run; };
  for (uint32_t p : graph.order) {
    Pass& pass = graph.passes[p];
    pass.run = pass.alwaysRun || !pass.valid || importsChanged(graph, pass) || programsChanged(graph, pass);
  }
  for (bool changed = true; changed;) {
    changed = false;
    for (uint32_t p : graph.order) {
      Pass& pass = graph.passes[p];
      if (pass.run || std::none_of(pass.inputs.begin(), pass.inputs.end(), runs)) continue;
      pass.run = changed = true;
    }
    for (const WriteChain& chain : graph.chains) {
      const bool any = std::any_of(chain.writers.begin(), chain.writers.end(), runs) ||
                       std::any_of(chain.earlyReaders.begin(), chain.earlyReaders.end(), runs);
      if (!any || std::all_of(chain.writers.begin(), chain.writers.end(), runs)) continue;
      for (uint32_t p : chain.writers) graph.passes[p].run = true;
      changed = true;
    }
  }
}

void noteRun(Graph& graph, Pass& pass) {
  pass.valid = true;
  for (ImportSeen& seen : pass.imports) {
    const Resource& r = graph.resources[seen.resource];
    seen.revision = r.revision;
    seen.id = importedId(r);
  }
  for (const uint32_t index : pass.programs)
    graph.programs[index].ranWith = graph.programs[index].program->serial();
}

}  // namespace limn::frame
