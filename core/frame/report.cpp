// What the graph says about itself: --explain, Graphviz, and the programs of its passes.
#include <fmt/format.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/frame/private/graph_data.h"
#include "core/frame/program_report.h"

namespace limn::frame {
namespace {

/// The declared bytes: those of an imported object, or of the description.
int64_t bytesOf(const Resource& r) {
  if (r.importedTexture != nullptr) return gpu::textureBytes(r.importedTexture->desc());
  if (r.importedBuffer != nullptr) return static_cast<int64_t>(r.importedBuffer->size());
  return r.texture ? gpu::textureBytes(r.textureDesc) : static_cast<int64_t>(r.bufferDesc.bytes);
}

AccessReport described(const Graph& graph, const ResourceAccess& a) {
  const Resource& r = graph.resources[a.resource];
  AccessReport report{r.name, a.access, a.write(), a.why, {}, bytesOf(r)};
  if (r.texture) report.texture = r.importedTexture ? r.importedTexture->desc() : r.textureDesc;
  return report;
}

SamplingReport samplingOf(const gl::Functions& gl, const gpu::Texture& texture, const gpu::Sampler* sampler) {
  const auto parameter = [&](GLenum which) {
    GLint value = 0;
    if (sampler != nullptr)
      gl.GetSamplerParameteriv(sampler->id(), which, &value);
    else
      gl.GetTextureParameteriv(texture.id(), which, &value);
    return static_cast<GLenum>(value);
  };
  return {parameter(GL_TEXTURE_MIN_FILTER),
          parameter(GL_TEXTURE_MAG_FILTER),
          {parameter(GL_TEXTURE_WRAP_S), parameter(GL_TEXTURE_WRAP_T), parameter(GL_TEXTURE_WRAP_R)}};
}

NameReport described(const Graph& graph, const Pass& pass, const Place& place) {
  const NamedResource& named = pass.names[place.name];
  const bool slot = named.slot();
  NameReport report;
  report.kind = place.kind;
  report.name = named.name;
  report.slot = slot;
  report.level = slot ? place.slot.level : named.level;
  report.layer = slot ? place.slot.layer : named.layer;
  report.texture = slot ? place.slot.texture : named.texture;
  report.buffer = slot ? place.slot.buffer : named.buffer;
  report.offset = place.slot.offset;
  const uint32_t access = slot ? place.slot.access : named.access;
  if (access != kNoIndex) {
    const Resource& resource = graph.resources[pass.accesses[access].resource];
    report.access = access;
    report.texture = resource.textureObject;
    report.buffer = resource.bufferObject;
    report.bytes = bytesOf(resource);
  } else if (report.texture != nullptr) {
    report.bytes = gpu::textureBytes(report.texture->desc());
  } else if (report.buffer != nullptr) {
    report.bytes = static_cast<int64_t>(place.slot.bytes > 0 ? place.slot.bytes : report.buffer->size());
  }
  if (place.kind == gpu::ShaderResource::Kind::sampler && report.texture != nullptr)
    report.sampling =
        samplingOf(graph.device->gl(), *report.texture, slot ? place.slot.sampler : named.sampler);
  return report;
}

PassReport report(const Graph& graph, uint32_t index) {
  const Pass& pass = graph.passes[index];
  PassReport row;
  row.name = pass.name;
  row.technique = pass.technique;
  row.role = pass.role;
  row.state = !pass.kept ? PassState::leftOut : pass.run ? PassState::run : PassState::cached;
  row.reason = !pass.kept ? pass.reason : pass.run ? "" : "inputs unchanged";
  row.barriers = pass.barriers;
  row.triangles = pass.triangles;
  std::vector<uint32_t> counted;
  for (const ResourceAccess& a : pass.accesses) {
    row.accesses.push_back(described(graph, a));
    const Resource& r = graph.resources[a.resource];
    const bool firstWriter = a.write() && r.first != kNoIndex && graph.order[r.first] == index;
    if (firstWriter && std::find(counted.begin(), counted.end(), a.resource) == counted.end()) {
      counted.push_back(a.resource);
      row.bytes += resourceBytes(r);
    }
  }
  return row;
}

/// Text within double quotes of a DOT file.
std::string escaped(std::string_view text) {
  std::string result;
  for (char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    if (c == '\n') {
      result += "\\n";
    } else if (static_cast<unsigned char>(c) >= 0x20) {
      result += c;
    }
  }
  return result;
}

std::string passNode(const std::string& id, const std::string& title, PassState state,
                     const std::string& reason) {
  const std::string label = reason.empty() ? escaped(title) : escaped(title) + "\\n" + escaped(reason);
  const char* style = state == PassState::leftOut  ? "dashed"
                      : state == PassState::cached ? "filled"
                                                   : "solid";
  return fmt::format("  {} [shape=box, style={}, label=\"{}\"];\n", id, style, label);
}

std::string resourceNodes(const Graph& graph) {
  std::string text;
  for (size_t i = 0; i < graph.resources.size(); ++i) {
    const Resource& r = graph.resources[i];
    for (size_t v = 0; v < r.versions.size(); ++v) {
      const Version& version = r.versions[v];
      if (v == 0 && version.readers.empty() && !r.imported()) continue;
      const bool dashed = version.producer != kNoIndex && !graph.passes[version.producer].kept;
      const bool output =
          std::find(r.outputs.begin(), r.outputs.end(), static_cast<uint32_t>(v)) != r.outputs.end();
      text += fmt::format("  r{}_{} [shape=ellipse, style={}, peripheries={}, label=\"{}{}\"];\n", i, v,
                          dashed ? "dashed" : "solid", output ? 2 : 1, escaped(r.name),
                          v > 1 || (r.imported() && v > 0) ? fmt::format(" v{}", v) : "");
    }
  }
  return text;
}

std::string edges(const Graph& graph, size_t index) {
  std::string text;
  const Pass& pass = graph.passes[index];
  const char* style = pass.kept ? "solid" : "dashed";
  const auto arrow = [&](const std::string& from, const std::string& to, const ResourceAccess& a) {
    text += fmt::format("  {} -> {} [style={}, label=\"{}\", tooltip=\"{}\"];\n", from, to, style,
                        name(a.access), escaped(a.why));
  };
  for (const ResourceAccess& a : pass.accesses) {
    const Resource& r = graph.resources[a.resource];
    const std::string passId = fmt::format("p{}", index);
    const auto node = [&](uint32_t version) { return fmt::format("r{}_{}", a.resource, version); };
    if (!a.write()) {
      arrow(node(a.version), passId, a);
      continue;
    }
    if (a.parent > 0 || r.imported()) arrow(node(a.parent), passId, a);
    arrow(passId, node(a.version), a);
  }
  return text;
}

void requirePlan(const Graph& graph) {
  if (!graph.planned) throw Error("frame graph: not planned; call plan() or prepare() first");
}

}  // namespace

std::string AccessReport::text() const {
  return why.empty() ? fmt::format("{} ({})", resource, name(access))
                     : fmt::format("{} ({}): {}", resource, name(access), why);
}

std::string_view name(PassRole role) {
  switch (role) {
    case PassRole::core:
      return "core";
    case PassRole::map:
      return "map";
    case PassRole::filter:
      return "filter";
    case PassRole::technique:
      return "technique";
  }
  return "unknown";
}

std::string_view name(PassState state) {
  switch (state) {
    case PassState::run:
      return "run";
    case PassState::cached:
      return "cached";
    case PassState::leftOut:
      return "left_out";
  }
  return "unknown";
}

std::vector<PassReport> FrameGraph::explain() const {
  const Graph& graph = *implementation_;
  requirePlan(graph);
  std::vector<PassReport> rows;
  for (uint32_t p : graph.order) rows.push_back(report(graph, p));
  for (uint32_t p = 0; p < graph.passes.size(); ++p) {
    if (!graph.passes[p].kept) rows.push_back(report(graph, p));
  }
  for (const LeftOut& entry : graph.leftOut) {
    PassReport& row = rows.emplace_back();
    row.name = entry.name;
    row.technique = entry.technique;
    row.role = defaultRole(entry.technique);
    row.state = PassState::leftOut;
    row.reason = entry.reason;
  }
  return rows;
}

std::string_view name(gpu::ShaderResource::Kind kind) {
  using Kind = gpu::ShaderResource::Kind;
  switch (kind) {
    case Kind::sampler:
      return "sampler";
    case Kind::image:
      return "image";
    case Kind::uniformBlock:
      return "uniform block";
    case Kind::storageBlock:
      return "storage block";
  }
  return "unknown";
}

std::vector<ProgramReport> FrameGraph::programs() const {
  const Graph& graph = *implementation_;
  if (graph.device == nullptr) throw Error("frame graph: programs() before prepare()");
  std::vector<ProgramReport> reports;
  for (size_t position = 0; position < graph.order.size(); ++position) {
    const Pass& pass = graph.passes[graph.order[position]];
    for (const uint32_t index : pass.programs) {
      const ProgramUse& use = graph.programs[index];
      ProgramReport& report = reports.emplace_back();
      report.pass = position;
      report.desc = use.desc;
      report.program = use.program;
      for (const Place& place : use.places) report.names.push_back(described(graph, pass, place));
      report.dispatches = use.dispatches;
      report.groups = use.groups;
    }
  }
  return reports;
}

std::string FrameGraph::graphviz() const {
  const Graph& graph = *implementation_;
  requirePlan(graph);
  std::string text = "digraph frame {\n  rankdir=LR;\n  node [fontname=\"sans-serif\"];\n";
  for (uint32_t p = 0; p < graph.passes.size(); ++p) {
    const PassReport row = report(graph, p);
    text += passNode(fmt::format("p{}", p), graph.title(p), row.state, row.reason);
  }
  for (size_t i = 0; i < graph.leftOut.size(); ++i) {
    const LeftOut& entry = graph.leftOut[i];
    const std::string title = entry.technique == "core" ? entry.name : entry.technique + "/" + entry.name;
    text += passNode(fmt::format("l{}", i), title, PassState::leftOut, entry.reason);
  }
  text += resourceNodes(graph);
  for (size_t p = 0; p < graph.passes.size(); ++p) text += edges(graph, p);
  return text + "}\n";
}

}  // namespace limn::frame
