#include "apps/view/view_state.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/shell.h"

namespace limn::app {
namespace {

/// The shortest text that reads as the same numbers.
std::string worldText(const glm::vec3& v, const glm::dvec3& origin) {
  if (origin == glm::dvec3(0)) return fmt::format("{},{},{}", v.x, v.y, v.z);
  const glm::dvec3 world = origin + glm::dvec3(v);
  return fmt::format("{},{},{}", world.x, world.y, world.z);
}

/// TOML basic string.
std::string tomlText(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    if (static_cast<unsigned char>(c) < 0x20)
      result += fmt::format("\\u{:04x}", static_cast<int>(c));
    else
      result += c;
  }
  return result + "\"";
}

/// Parameters that are not at their defaults: name and printed value.
std::vector<std::pair<std::string, std::string>> changed(const render::TechniqueUse& use) {
  const auto now = use.parameters.printed();
  const auto before = ParameterValues(use.plugin->info->name, use.plugin->info->parameters).printed();
  std::vector<std::pair<std::string, std::string>> result;
  for (size_t i = 0; i < now.size(); ++i)
    if (now[i].second != before[i].second) result.push_back(now[i]);
  return result;
}

std::string techniqueNames(const std::vector<render::TechniqueUse>& uses) {
  std::string names;
  for (const render::TechniqueUse& use : uses)
    names += (names.empty() ? "" : ",") + std::string(use.plugin->info->name);
  return names;
}

class CommandLine {
 public:
  explicit CommandLine(const std::string& start) : text_(start) {}
  /// Left out where `value` is empty.
  CommandLine& add(const char* option, const std::string& value) {
    if (!value.empty()) text_ += fmt::format(" {} {}", option, shellQuoted(value));
    return *this;
  }
  /// Left out where `value` is `standard`.
  template <class T>
  CommandLine& add(const char* option, const T& value, const T& standard) {
    if (!(value == standard)) text_ += fmt::format(" {} {}", option, shellQuoted(fmt::format("{}", value)));
    return *this;
  }
  std::string text() const { return text_; }

 private:
  std::string text_;
};

}  // namespace

void setCamera(SceneOptions& options, const Orbit& orbit, const glm::dvec3& origin) {
  options.eye = worldText(orbit.eye(), origin);
  options.target = worldText(orbit.target(), origin);
}

void dropRivals(std::vector<render::TechniqueUse>& techniques, const TechniquePlugin& added) {
  const auto claims = [](const TechniquePlugin& plugin, TermSet terms) {
    return (plugin.info->terms & terms) != 0;
  };
  const auto rivals = [&](const render::TechniqueUse& use) {
    if (use.plugin == &added) return false;
    for (const TermSet alone :
         {Term::visibility | Term::direct, termSet(Term::environment), termSet(Term::specular)})
      if (claims(*use.plugin, alone) && claims(added, alone)) return true;
    return false;
  };
  std::erase_if(techniques, rivals);
}

std::string renderCommand(const ViewState& state, const std::filesystem::path& out) {
  const SceneOptions& s = state.scene;
  const SceneOptions standard;
  CommandLine line("limn render " + shellQuoted(s.scene.string()));
  line.add("--technique", techniqueNames(state.techniques));
  for (const render::TechniqueUse& use : state.techniques)
    for (const auto& [name, value] : changed(use))
      line.add("--set", fmt::format("{}.{}={}", use.plugin->info->name, name, value));
  line.add("--camera", s.camera)
      .add("--eye", s.eye)
      .add("--target", s.target)
      .add("--fov", s.fov, standard.fov);
  line.add("--environment", s.environment.string())
      .add("--environment-rotation", s.environmentRotation, standard.environmentRotation)
      .add("--environment-scale", s.environmentScale, standard.environmentScale)
      .add("--environment-lights", s.environmentLights.threshold, standard.environmentLights.threshold)
      .add("--environment-resolution", s.environmentLights.resolution, standard.environmentLights.resolution)
      .add("--environment-shape", s.environmentLights.shape, standard.environmentLights.shape)
      .add("--environment-reflection", s.environmentReflection, standard.environmentReflection);
  line.add("--time", s.time, standard.time).add("--animation", s.animation);
  line.add("--light", s.light).add("--light-size", s.lightSize, standard.lightSize);
  for (const std::string& setting : s.lightSettings) line.add("--set-light", setting);
  line.add("--sigma-a", s.sigmaA).add("--sigma-s", s.sigmaS).add("--grid", s.grid);
  if (s.g) line.add("--g", fmt::format("{}", *s.g));
  line.add("--default-lights", s.defaultLights, standard.defaultLights);
  line.add("--size", s.size);
  line.add("--output-term", std::string(render::name(state.output)), std::string("final"));
  line.add("--exposure", state.exposure, 0.f);
  return line.add("--out", out.string()).text();
}

int bouncesOf(render::Output output, const std::vector<render::TechniqueUse>& techniques) {
  if (output == render::Output::indirect) return 1;
  const auto indirect = [](const render::TechniqueUse& use) {
    return contains(use.plugin->info->terms, Term::indirect);
  };
  return output == render::Output::final && std::ranges::any_of(techniques, indirect) ? 1 : 0;
}

namespace {

class TomlTable {
 public:
  /// Left out where `value` is empty.
  TomlTable& text(const char* key, const std::string& value) {
    if (!value.empty()) text_ += fmt::format("{} = {}\n", key, tomlText(value));
    return *this;
  }
  TomlTable& number(const char* key, double value) {
    text_ += fmt::format("{} = {}\n", key, value);
    return *this;
  }
  /// Left out where `value` is `standard`.
  TomlTable& number(const char* key, double value, double standard) {
    return value == standard ? *this : number(key, value);
  }
  TomlTable& texts(const char* key, const std::vector<std::string>& values) {
    std::string list;
    for (const std::string& value : values) list += (list.empty() ? "" : ", ") + tomlText(value);
    if (!values.empty()) text_ += fmt::format("{} = [{}]\n", key, list);
    return *this;
  }
  const std::string& written() const { return text_; }

 private:
  std::string text_;
};

std::string sceneTable(const SceneOptions& s) {
  const SceneOptions standard;
  TomlTable table;
  table.text("scene", s.scene.string()).text("cameras", s.camera).text("lights", s.light);
  table.text("eye", s.eye).text("target", s.target).number("fov", s.fov, standard.fov);
  table.number("light_sizes", s.lightSize, standard.lightSize).texts("set_light", s.lightSettings);
  table.number("time", s.time, standard.time).text("animation", s.animation);
  if (s.defaultLights != standard.defaultLights) table.text("default_lights", s.defaultLights);
  table.text("sigma_a", s.sigmaA).text("sigma_s", s.sigmaS).text("grid", s.grid);
  if (s.g) table.number("g", *s.g);
  if (s.environment.empty()) return table.written();
  table.text("environment", s.environment.string())
      .number("environment_rotation", s.environmentRotation, standard.environmentRotation)
      .number("environment_scale", s.environmentScale, standard.environmentScale);
  const EnvironmentLightOptions& lights = s.environmentLights;
  if (lights.threshold > 0)
    table.number("environment_lights", lights.threshold, 0)
        .number("environment_resolution", lights.resolution, standard.environmentLights.resolution)
        .text("environment_shape", lights.shape)
        .text("environment_reflection", s.environmentReflection);
  return table.written();
}

std::string techniqueTable(const std::vector<render::TechniqueUse>& uses) {
  std::string text = fmt::format("\n[[techniques]]\ntechnique = {}\n", tomlText(techniqueNames(uses)));
  std::string values;
  for (const render::TechniqueUse& use : uses)
    for (const auto& [name, value] : changed(use)) {
      const std::string key = uses.size() > 1 ? fmt::format("\"{}.{}\"", use.plugin->info->name, name) : name;
      values += fmt::format("{}{} = [{}]", values.empty() ? "" : ", ", key, tomlText(value));
    }
  if (!values.empty()) text += fmt::format("parameters = {{{}}}\n", values);
  return text;
}

}  // namespace

std::string benchSuite(const ViewState& state) {
  const int bounces = bouncesOf(state.output, state.techniques);
  const int interfaces = render::interfacesOf(state.output, state.techniques);
  std::string text = fmt::format(
      "# Saved by limn-view: `limn bench` on this file measures what it showed.\nname = \"view\"\nsizes = "
      "[{}]\nterm = {}\n",
      tomlText(state.scene.size), tomlText(std::string(render::name(state.output))));
  text += fmt::format("reference = {{noise = 0.02, spp = 4096{}{}}}\npictures = true\n\n[[scenes]]\n",
                      bounces > 0 ? fmt::format(", bounces = {}", bounces) : "",
                      interfaces > 0 ? fmt::format(", interfaces = {}", interfaces) : "");
  text += sceneTable(state.scene);
  if (!state.techniques.empty()) text += techniqueTable(state.techniques);
  return text;
}

}  // namespace limn::app
