// limn import: models of other formats as glTF, by assimp.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "apps/limn/commands.h"
#include "apps/limn/interruption.h"
#include "apps/limn/options.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/spawn.h"
#include "core/base/text.h"
#include "core/scene_io/load.h"

namespace limn::app {
namespace fs = std::filesystem;
namespace {

constexpr const char* kConverter = "assimp";
constexpr const char* kInterrupted = "interrupted; no scene was written";

/// What assimp says went wrong, or how it ended.
std::string reason(const ProgramOutput& output) {
  constexpr std::string_view mark = "ERROR: ";
  const std::size_t at = output.text.find(mark);
  if (at == std::string::npos) return kConverter + (" failed: " + output.failure);
  const std::size_t start = at + mark.size();
  return oneLine(output.text.substr(start, output.text.find('\n', start) - start));
}

void endIfAsked(const Interruption& interruption) {
  if (interruption.asked()) throw Interrupted{interruption.signal(), kInterrupted};
}

std::string assimp(const std::vector<std::string>& arguments, const fs::path& model,
                   const Interruption& interruption) {
  const ProgramOutput output =
      programOutput(kConverter, arguments, false, [&] { return interruption.asked(); });
  endIfAsked(interruption);
  if (!output.failure.empty() || output.text.find("ERROR: ") != std::string::npos)
    throw Error(fmt::format("{}: {}", model.string(), reason(output)));
  return output.text;
}

/// How many of a kind the model has, by what assimp says of it.
std::size_t countOf(const std::string& information, const std::string& kind) {
  const std::size_t at = information.find("\n" + kind + ":");
  return at == std::string::npos ? 0 : std::strtoul(information.c_str() + at + kind.size() + 2, nullptr, 10);
}

/// How many textures the model's materials name, each counted once.
std::size_t texturesOf(const std::string& information) {
  const std::string title = "\nTexture Refs:\n";
  const std::size_t at = information.find(title);
  if (at == std::string::npos) return 0;
  std::istringstream lines(information.substr(at + title.size()));
  std::set<std::string> names;
  for (std::string line; std::getline(lines, line) && line.starts_with("    '");) names.insert(line);
  return names.size();
}

/// How many of the images of a scene are different ones: the same one may be there as colour and as data.
std::size_t imagesOf(const scene::Scene& scene) {
  std::set<std::string> names;
  for (const scene::TextureImage& image : scene.images) names.insert(image.name);
  return names.size();
}

/// How many of the animations of a scene move anything: assimp writes those of morph targets without that.
std::size_t animationsOf(const scene::Scene& scene) {
  return static_cast<std::size_t>(std::ranges::count_if(
      scene.animations, [](const scene::Animation& animation) { return !animation.channels.empty(); }));
}

/// The meshes in the JSON of a .glb that was read.
nlohmann::json meshesOf(const fs::path& file) {
  std::array<char, 20> header{};
  std::uint32_t length = 0;
  std::ifstream in(file, std::ios::binary);
  in.read(header.data(), header.size());
  std::memcpy(&length, &header[12], sizeof length);
  std::string text(length, ' ');
  in.read(text.data(), length);
  return nlohmann::json::parse(text).value("meshes", nlohmann::json::array());
}

/// How many sets of a kind of vertex attribute the meshes have, and how many are read: one of each primitive.
std::pair<std::size_t, std::size_t> attributeSets(const nlohmann::json& meshes, const std::string& kind) {
  std::pair<std::size_t, std::size_t> counts;
  for (const nlohmann::json& mesh : meshes) {
    for (const nlohmann::json& primitive : mesh.at("primitives")) {
      const nlohmann::json& attributes = primitive.at("attributes");
      std::size_t sets = 0;
      while (attributes.contains(fmt::format("{}_{}", kind, sets))) ++sets;
      counts.first += sets;
      counts.second += std::min<std::size_t>(sets, 1);
    }
  }
  return counts;
}

std::string size(const scene::Bounds& bounds) {
  if (bounds.empty()) return "nothing to draw";
  const glm::vec3 side = bounds.high - bounds.low;
  return fmt::format("{:.4g} x {:.4g} x {:.4g} m", side.x, side.y, side.z);
}

int run(const fs::path& model, fs::path out) {
  std::error_code ignored;
  if (!fs::is_regular_file(model, ignored)) throw UsageError(fmt::format("{}: no such file", model.string()));
  if (out.empty()) {
    out = fs::path(model).replace_extension(".glb");
    if (fs::exists(out, ignored))
      throw UsageError(fmt::format("{} is there already; --out names another file", out.string()));
  }
  if (out.extension() != ".glb")
    throw UsageError(fmt::format("--out {}: a file with the extension .glb is written", out.string()));
  checkApart({out}, {model});
  checkWritable(out);
  if (!programExists(kConverter))
    throw Error(
        "models of other formats are read by assimp, which is not installed: apt-get install assimp-utils");

  const LastWords words(kInterrupted);
  const Interruption interruption;  // assimp and what it has half-written go before the program
  const std::string information = assimp({"info", model.string()}, model, interruption);
  TemporaryFile part(out);
  assimp({"export", model.string(), part.path().string(), "-fglb2", "-tri", "-gsn"}, model, interruption);
  scene::Scene scene;
  try {
    scene = scene::load(part.path());
  } catch (const Error& error) {
    throw Error(fmt::format("{}: what assimp makes of it cannot be read: {}", model.string(), error.what()));
  }
  const std::string partName = part.path().filename().string();
  for (std::string warning : scene.warnings) {
    if (const std::size_t at = warning.find(partName); at != std::string::npos)
      warning.replace(at, partName.size(), out.filename().string());
    warn(warning);
  }
  const nlohmann::json meshes = meshesOf(part.path());
  endIfAsked(interruption);
  part.keep();

  const std::pair<const char*, std::pair<std::size_t, std::size_t>> kinds[] = {
      {"cameras", {countOf(information, "Cameras"), scene.cameras.size()}},
      {"lights", {countOf(information, "Lights"), scene.lights.size()}},
      {"animations", {countOf(information, "Animations"), animationsOf(scene)}},
      {"materials", {countOf(information, "Materials"), scene.materials.size()}},
      {"textures", {texturesOf(information), imagesOf(scene)}},
      {"sets of texture coordinates", attributeSets(meshes, "TEXCOORD")},
      {"sets of vertex colours", attributeSets(meshes, "COLOR")}};
  std::vector<std::string> lost;
  for (const auto& [kind, counts] : kinds)
    if (counts.first > counts.second)
      lost.push_back(fmt::format("{} of {} {}", counts.first - counts.second, counts.first, kind));
  fmt::print("{}: {} triangles, {} materials, {} textures, {} animations, {}; {}\n", out.string(),
             scene.triangles(), scene.materials.size(), scene.images.size(), animationsOf(scene),
             size(evaluate(scene, 0).bounds),
             lost.empty() ? std::string("nothing that is counted was lost") : "lost: " + joined(lost));
  return 0;
}

}  // namespace

Action addImportCommand(CLI::App& command) {
  const auto model = std::make_shared<fs::path>(), out = std::make_shared<fs::path>();
  command
      .add_option("model", *model, "A file that assimp reads: OBJ, PLY, STL, FBX, COLLADA, 3DS, Blender ...")
      ->required();
  command.add_option("-o,--out", *out,
                     "The scene, a .glb file; default: beside the model, where its textures are");
  return [model, out] { return run(*model, *out); };
}

}  // namespace limn::app
