#include "apps/limn/pass_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/base/error.h"
#include "core/base/json_depth.h"
#include "core/base/text.h"
#include "core/bench/markdown_text.h"
#include "core/gpu/format.h"

namespace limn::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kGenerator = "limn passes";

std::string glName(GLenum value) {
  switch (value) {
#define LIMN_NAME(NAME) \
  case NAME:            \
    return #NAME;
    LIMN_NAME(GL_NEAREST)
    LIMN_NAME(GL_LINEAR)
    LIMN_NAME(GL_NEAREST_MIPMAP_NEAREST)
    LIMN_NAME(GL_LINEAR_MIPMAP_NEAREST)
    LIMN_NAME(GL_NEAREST_MIPMAP_LINEAR)
    LIMN_NAME(GL_LINEAR_MIPMAP_LINEAR)
    LIMN_NAME(GL_REPEAT)
    LIMN_NAME(GL_MIRRORED_REPEAT)
    LIMN_NAME(GL_CLAMP_TO_EDGE)
    LIMN_NAME(GL_CLAMP_TO_BORDER)
    LIMN_NAME(GL_TEXTURE_2D)
    LIMN_NAME(GL_TEXTURE_2D_ARRAY)
    LIMN_NAME(GL_TEXTURE_3D)
    LIMN_NAME(GL_TEXTURE_CUBE_MAP)
    LIMN_NAME(GL_TEXTURE_CUBE_MAP_ARRAY)
#undef LIMN_NAME
    default:
      return fmt::format("{:#x}", value);
  }
}

std::string barrierNames(GLbitfield bits) {
  constexpr std::pair<GLbitfield, const char*> kBits[] = {
      {GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT, "GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT"},
      {GL_ELEMENT_ARRAY_BARRIER_BIT, "GL_ELEMENT_ARRAY_BARRIER_BIT"},
      {GL_UNIFORM_BARRIER_BIT, "GL_UNIFORM_BARRIER_BIT"},
      {GL_TEXTURE_FETCH_BARRIER_BIT, "GL_TEXTURE_FETCH_BARRIER_BIT"},
      {GL_SHADER_IMAGE_ACCESS_BARRIER_BIT, "GL_SHADER_IMAGE_ACCESS_BARRIER_BIT"},
      {GL_COMMAND_BARRIER_BIT, "GL_COMMAND_BARRIER_BIT"},
      {GL_TEXTURE_UPDATE_BARRIER_BIT, "GL_TEXTURE_UPDATE_BARRIER_BIT"},
      {GL_BUFFER_UPDATE_BARRIER_BIT, "GL_BUFFER_UPDATE_BARRIER_BIT"},
      {GL_FRAMEBUFFER_BARRIER_BIT, "GL_FRAMEBUFFER_BARRIER_BIT"},
      {GL_SHADER_STORAGE_BARRIER_BIT, "GL_SHADER_STORAGE_BARRIER_BIT"}};
  std::vector<const char*> names;
  for (const auto& [bit, text] : kBits)
    if ((bits & bit) != 0) names.push_back(text);
  std::string all = fmt::format("{}", fmt::join(names, " | "));
  for (const auto& [bit, text] : kBits) bits &= ~bit;
  return bits == 0 ? all : fmt::format("{}{}{:#x}", all, all.empty() ? "" : " | ", bits);
}

/// "RGBA32F 640 x 480", "R32F GL_TEXTURE_2D_ARRAY 512 x 512 x 3, 10 levels", "1024 bytes".
std::string shapeOf(const std::optional<gpu::TextureDesc>& declared, int64_t bytes) {
  if (!declared) return bytes > 0 ? fmt::format("{} bytes", bytes) : "";
  const gpu::TextureDesc texture = gpu::resolved(*declared);
  std::string text = gpu::formatInfo(texture.format).name;
  if (texture.target != GL_TEXTURE_2D) text += " " + glName(texture.target);
  text += fmt::format(" {} x {}", texture.width, texture.height);
  if (texture.layers > 1) text += fmt::format(" x {}", texture.layers);
  if (texture.levels > 1) text += fmt::format(", {} levels", texture.levels);
  return text;
}

std::string shapeOf(const frame::NameReport& name) {
  return shapeOf(name.texture ? std::optional(name.texture->desc()) : std::nullopt, name.bytes);
}

std::string samplingText(const frame::SamplingReport& sampling) {
  return fmt::format("{}, {}, {}", glName(sampling.minFilter), glName(sampling.magFilter),
                     glName(sampling.wrap[0]));
}

/// Letters and digits; anything else becomes a '-'.
std::string fileWord(std::string_view text) {
  std::string word;
  for (const char c : text) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
    if (plain || (!word.empty() && word.back() != '-')) word += plain ? c : '-';
  }
  while (word.ends_with('-')) word.pop_back();
  return word;
}

/// ".comp.glsl" of "techniques/pcss/visibility.comp.glsl".
std::string stageEnding(const std::string& file) {
  const size_t name = file.rfind('/') + 1;
  return file.substr(file.find('.', name));
}

std::vector<std::byte> contentsOf(const gpu::Texture& texture, int level) {
  const gpu::TextureDesc& desc = texture.desc();
  const gpu::FormatInfo format = gpu::formatInfo(desc.format);
  const auto extent = [&](int size) { return static_cast<size_t>(std::max(1, size >> level)); };
  std::vector<std::byte> bytes(extent(desc.width) * extent(desc.height) *
                               static_cast<size_t>(texture.layersOf(level)) *
                               gpu::clientPixelBytes(format.clientFormat, format.clientType));
  texture.read(level, format.clientFormat, format.clientType, bytes.data(), bytes.size());
  return bytes;
}

enum class Moment { before, after };

class Recorder {
 public:
  Recorder(render::Renderer& renderer, std::string wanted)
      : renderer_(renderer), wanted_(std::move(wanted)) {}

  FrameRecord run() {
    renderer_.render();  // passes bind to slots while they run
    std::optional<size_t> wanted;
    if (!wanted_.empty()) wanted = find();
    // Between two passes a program still has the values that the first of them set, and a resource what it
    // left there.
    size_t begun = 0;
    const auto between = [&] {
      if (begun > 0) readUniforms(begun - 1);
      if (wanted && begun == *wanted) keepContents(*wanted, Moment::before);
      if (wanted && begun == *wanted + 1) keepContents(*wanted, Moment::after);
      ++begun;
    };
    renderer_.render(frame::Timing::off, [&] {
      between();
      return false;
    });
    between();
    for (const frame::PassReport& report : renderer_.explain()) frame_.passes.push_back({report, {}});
    if (wanted && frame_.contents.empty())
      throw UsageError(
          fmt::format("pass '{}' binds nothing to a name in a shader: it has no contents", wanted_));
    const std::vector<frame::ProgramReport> programs = renderer_.graph().programs();
    for (size_t i = 0; i < programs.size(); ++i)
      frame_.passes[programs[i].pass].programs.push_back(record(programs[i], uniforms_[i]));
    return std::move(frame_);
  }

 private:
  /// The index of the wanted pass.
  size_t find() const {
    std::vector<std::string> known;
    for (const frame::PassReport& pass : renderer_.explain())
      if (pass.state != frame::PassState::leftOut) known.push_back(pass.technique + "/" + pass.name);
    const auto found = std::ranges::find(known, wanted_);
    if (found == known.end())
      throw UsageError(fmt::format("pass '{}' is not in the frame{}; there are {}", wanted_,
                                   didYouMean(wanted_, known), joined(known)));
    return static_cast<size_t>(found - known.begin());
  }

  void readUniforms(size_t pass) {
    const std::vector<frame::ProgramReport> programs = renderer_.graph().programs();
    uniforms_.resize(programs.size());
    for (size_t i = 0; i < programs.size(); ++i)
      if (programs[i].pass == pass) uniforms_[i] = gpu::uniformValues(*programs[i].program);
  }

  /// Keeps what a pass reads or, after it, what it wrote.
  void keepContents(size_t pass, Moment moment) {
    const frame::PassReport report = renderer_.explain()[pass];
    const std::string folder = moment == Moment::before ? "before/" : "after/";
    for (const frame::ProgramReport& program : renderer_.graph().programs()) {
      if (program.pass != pass) continue;
      for (const frame::NameReport& name : program.names) {
        const bool written = name.access && report.accesses[*name.access].write;
        if (moment == Moment::before || written) keepContents(folder + name.name, name);
      }
    }
  }

  void keepContents(const std::string& file, const frame::NameReport& name) {
    if (name.buffer != nullptr) {
      std::vector<std::byte>& bytes = frame_.contents[file];
      bytes.resize(static_cast<size_t>(name.bytes));
      if (!bytes.empty()) name.buffer->read(name.offset, bytes.data(), bytes.size());
    }
    if (name.texture == nullptr) return;
    for (int level = 0; level < name.texture->desc().levels; ++level)
      frame_.contents[fmt::format("{}.{}", file, level)] = contentsOf(*name.texture, level);
  }

  ProgramRecord record(const frame::ProgramReport& report, const std::vector<gpu::UniformValue>& uniforms) {
    ProgramRecord program{report, {}, uniforms};
    std::vector<std::string>& known = files_[report.desc];
    if (known.empty()) {
      const PassRecord& pass = frame_.passes[report.pass];
      std::string stem = fmt::format("{:02}-{}-{}", report.pass + 1, fileWord(pass.report.technique),
                                     fileWord(pass.report.name));
      if (!pass.programs.empty()) stem += fmt::format("-{}", pass.programs.size() + 1);
      for (const std::string& file : report.desc.files) {
        known.push_back(stem + stageEnding(file));
        frame_.shaders[known.back()] = renderer_.shaderText(report.desc, file);
      }
    }
    program.shaders = known;
    return program;
  }

  render::Renderer& renderer_;
  std::string wanted_;
  FrameRecord frame_;
  std::vector<std::vector<gpu::UniformValue>> uniforms_;  // by program
  std::map<gpu::ProgramDesc, std::vector<std::string>> files_;
};

Json textureJson(const gpu::TextureDesc& declared) {
  const gpu::TextureDesc texture = gpu::resolved(declared);
  const gpu::FormatInfo format = gpu::formatInfo(texture.format);
  return {{"target", glName(texture.target)},
          {"format", format.name},
          {"width", texture.width},
          {"height", texture.height},
          {"layers", texture.layers},
          {"levels", texture.levels},
          {"pixel_format", format.clientFormat},
          {"pixel_type", format.clientType}};
}

/// Numbers textures and buffers in the order in which they are first met.
class Objects {
 public:
  size_t numberOf(const frame::NameReport& name) {
    const void* object = name.texture != nullptr ? static_cast<const void*>(name.texture) : name.buffer;
    return numbers_.try_emplace({object, name.offset}, numbers_.size()).first->second;
  }

 private:
  std::map<std::pair<const void*, size_t>, size_t> numbers_;
};

bool bound(const frame::NameReport& name) {
  return name.texture != nullptr || name.buffer != nullptr;
}

Json nameJson(const frame::NameReport& name, const frame::PassReport& pass, Objects& objects) {
  Json json{{"name", name.name}, {"kind", frame::name(name.kind)}, {"slot", name.slot}};
  if (bound(name)) json["object"] = objects.numberOf(name);
  if (name.access) {
    json["resource"] = pass.accesses[*name.access].resource;
    json["written"] = pass.accesses[*name.access].write;
  }
  if (name.texture) json["texture"] = textureJson(name.texture->desc());
  json["bytes"] = name.bytes;
  if (name.kind == gpu::ShaderResource::Kind::image) {
    json["level"] = name.level;
    json["layer"] = name.layer;
  }
  if (name.sampling)
    json["sampling"] = {
        {"min_filter", glName(name.sampling->minFilter)},
        {"mag_filter", glName(name.sampling->magFilter)},
        {"wrap",
         {glName(name.sampling->wrap[0]), glName(name.sampling->wrap[1]), glName(name.sampling->wrap[2])}}};
  return json;
}

Json programJson(const ProgramRecord& program, const frame::PassReport& pass) {
  Json names = Json::array(), uniforms = Json::array();
  Objects objects;
  for (const frame::NameReport& name : program.report.names) names.push_back(nameJson(name, pass, objects));
  for (const gpu::UniformValue& uniform : program.uniforms)
    uniforms.push_back({{"name", uniform.name}, {"type", uniform.type}, {"value", uniform.value}});
  return {{"files", program.report.desc.files},
          {"defines", program.report.desc.defines},
          {"shaders", program.shaders},
          {"names", names},
          {"uniforms", uniforms},
          {"dispatches", program.report.dispatches},
          {"groups", program.report.groups}};
}

Json passJson(const PassRecord& pass) {
  const frame::PassReport& report = pass.report;
  Json accesses = Json::array(), programs = Json::array();
  for (const frame::AccessReport& access : report.accesses) {
    Json json{{"resource", access.resource}, {"access", frame::name(access.access)}, {"why", access.why}};
    if (access.texture) json["texture"] = textureJson(*access.texture);
    json["bytes"] = access.bytes;
    accesses.push_back(std::move(json));
  }
  for (const ProgramRecord& program : pass.programs) programs.push_back(programJson(program, report));
  return {{"pass", report.name},
          {"technique", report.technique},
          {"role", frame::name(report.role)},
          {"state", frame::name(report.state)},
          {"reason", report.reason},
          {"barriers", barrierNames(report.barriers)},
          {"triangles", report.triangles},
          {"accesses", accesses},
          {"programs", programs}};
}

std::string workOf(const PassRecord& pass) {
  std::vector<std::string> work;
  if (pass.report.triangles > 0) work.push_back(fmt::format("{} triangles", pass.report.triangles));
  for (const ProgramRecord& program : pass.programs) {
    const frame::ProgramReport& report = program.report;
    if (report.dispatches == 0) continue;
    const std::string groups =
        fmt::format("{} x {} x {}", report.groups[0], report.groups[1], report.groups[2]);
    work.push_back(report.dispatches == 1
                       ? groups + " groups"
                       : fmt::format("{} dispatches, the last of {} groups", report.dispatches, groups));
  }
  if (work.empty() && pass.programs.empty()) return "no program: a clear, a copy, or work on the processor";
  return fmt::format("{}", fmt::join(work, "; "));
}

/// One line for each uniform, or for all elements of an array.
std::string uniformsMarkdown(const std::vector<gpu::UniformValue>& uniforms) {
  std::string text, array;
  for (const gpu::UniformValue& uniform : uniforms) {
    const size_t bracket = uniform.name.find('[');
    const std::string name = uniform.name.substr(0, bracket);
    if (bracket != std::string::npos && name == array) {
      text += fmt::format("; {}", uniform.value);
      continue;
    }
    array = bracket == std::string::npos ? "" : name;
    text += fmt::format("{}    {} {}{} = {}", text.empty() ? "" : "\n", uniform.type, name,
                        array.empty() ? "" : "[]", uniform.value);
  }
  return text.empty() ? text : text + "\n\n";
}

std::string programMarkdown(const ProgramRecord& program, const frame::PassReport& pass) {
  std::string text;
  for (size_t i = 0; i < program.shaders.size(); ++i)
    text += fmt::format("[`{0}`](shaders/{0}): {1}\n\n", program.shaders[i], program.report.desc.files[i]);
  if (!program.report.names.empty()) {
    text += "| name | kind | bound to it | shape | how, why |\n| --- | --- | --- | --- | --- |\n";
    std::map<size_t, std::string> firsts;  // names of objects
    Objects objects;
    for (const frame::NameReport& name : program.report.names) {
      std::vector<std::string> how;
      if (name.access) how.push_back(pass.accesses[*name.access].why);
      if (name.slot && bound(name)) how.push_back("bound for each draw or dispatch: the last");
      const auto same =
          bound(name) ? firsts.try_emplace(objects.numberOf(name), name.name).first : firsts.end();
      if (same != firsts.end() && same->second != name.name)
        how.push_back(fmt::format("the same as `{}`", same->second));
      const bool image = name.kind == gpu::ShaderResource::Kind::image;
      if (image && name.texture != nullptr && name.texture->desc().levels > 1)
        how.push_back(fmt::format("level {}", name.level));
      if (name.layer >= 0) how.push_back(fmt::format("layer {}", name.layer));
      if (name.sampling) how.push_back(samplingText(*name.sampling));
      const std::string holder = name.access   ? pass.accesses[*name.access].resource
                                 : bound(name) ? "a resource outside the graph"
                                               : "nothing in this frame";
      text += fmt::format("| `{}` | {} | {} | {} | {} |\n", name.name, frame::name(name.kind), holder,
                          shapeOf(name), fmt::join(how, "; "));
    }
    text += "\n";
  }
  return text + uniformsMarkdown(program.uniforms);
}

/// What no program reads or writes by a name: attachments, vertices, copies.
std::string namelessMarkdown(const PassRecord& pass) {
  std::string text;
  for (size_t i = 0; i < pass.report.accesses.size(); ++i) {
    const frame::AccessReport& access = pass.report.accesses[i];
    const bool named = std::ranges::any_of(pass.programs, [&](const ProgramRecord& program) {
      return std::ranges::any_of(program.report.names,
                                 [&](const frame::NameReport& name) { return name.access == i; });
    });
    if (!named) text += fmt::format("- {}, {}\n", access.text(), shapeOf(access.texture, access.bytes));
  }
  return text.empty() ? text : "Attachments, and what shaders have no name for:\n\n" + text + "\n";
}

std::string passMarkdown(const PassRecord& pass, size_t number) {
  std::string text = fmt::format("## {}. {} ({})\n\n", number, pass.report.name, pass.report.technique);
  if (pass.report.barriers != 0)
    text += fmt::format("Before it: `glMemoryBarrier({})`.\n\n", barrierNames(pass.report.barriers));
  if (const std::string work = workOf(pass); !work.empty()) text += fmt::format("Work: {}.\n\n", work);
  for (const ProgramRecord& program : pass.programs) text += programMarkdown(program, pass.report);
  text += namelessMarkdown(pass);
  while (text.ends_with("\n\n")) text.pop_back();
  return text;
}

}  // namespace

FrameRecord recordFrame(render::Renderer& renderer, const std::string& contentsOf) {
  return Recorder(renderer, contentsOf).run();
}

std::string toJson(const FrameRecord& frame, const std::vector<std::string>& files, bool complete) {
  Json passes = Json::array();
  for (const PassRecord& pass : frame.passes) passes.push_back(passJson(pass));
  return Json{{"generator", kGenerator}, {"complete", complete}, {"files", files}, {"passes", passes}}.dump(
             2) +
         "\n";
}

std::optional<std::vector<std::string>> filesOf(const std::string& json) {
  if (isTooDeepJson(json)) return std::nullopt;
  const Json read = Json::parse(json, nullptr, false);
  if (!read.is_object() || read.value("generator", Json()) != kGenerator) return std::nullopt;
  std::vector<std::string> files;
  for (const Json& file : read.value("files", Json::array()))
    if (file.is_string()) files.push_back(file);
  return files;
}

std::string toMarkdown(const FrameRecord& frame, const std::string& title) {
  std::string text = fmt::format(
      "# {}\n\nPasses in the order in which they run. `shaders/` holds their programs, each in one file that "
      "any "
      "OpenGL 4.5 compiler takes;\n`passes.json` says the same as this page.\n\n| | pass | of | role | work "
      "|\n| --: | --- | "
      "--- | --- | --- |\n",
      bench::markdownText(title));
  const auto kept = [](const PassRecord& pass) { return pass.report.state != frame::PassState::leftOut; };
  for (size_t i = 0; i < frame.passes.size(); ++i) {
    const PassRecord& pass = frame.passes[i];
    if (kept(pass))
      text += fmt::format("| {} | {} | {} | {} | {} |\n", i + 1, pass.report.name, pass.report.technique,
                          frame::name(pass.report.role), workOf(pass));
  }
  if (!std::ranges::all_of(frame.passes, kept))
    text += "\nLeft out, because this picture does not need them:\n\n";
  for (const PassRecord& pass : frame.passes)
    if (!kept(pass))
      text += fmt::format("- {} ({}): {}\n", pass.report.name, pass.report.technique, pass.report.reason);
  for (size_t i = 0; i < frame.passes.size(); ++i)
    if (kept(frame.passes[i])) text += "\n" + passMarkdown(frame.passes[i], i + 1);
  return text;
}

}  // namespace limn::app
