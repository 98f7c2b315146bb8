#include "core/bench/suite.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <set>

#include "core/base/error.h"

namespace limn::bench {

namespace {

/// The lights that stand for the environment, for people; empty where there are none.
std::string environmentLights(const EnvironmentSettings& e) {
  if (!(e.lights > 0)) return {};
  return fmt::format("{} {} {} {}", e.lights, e.resolution, e.shape, e.reflection);
}

}  // namespace

std::string describe(const MediumSettings& m) {
  std::string text;
  const auto add = [&text](const char* name, const std::string& value) {
    if (!value.empty()) text += fmt::format("{}{} {}", text.empty() ? "" : " ", name, value);
  };
  add("sigma_a", m.sigmaA);
  add("sigma_s", m.sigmaS);
  if (m.g) add("g", fmt::format("{}", *m.g));
  return text;
}

std::string describe(const SceneChanges& changes) {
  const SceneChanges none;
  std::string text;
  const auto add = [&text](bool changed, const std::string& what) {
    if (changed) text += (text.empty() ? "" : " ") + what;
  };
  add(!changes.eye.empty(), "eye " + changes.eye);
  add(!changes.target.empty(), "target " + changes.target);
  add(changes.fov != none.fov, fmt::format("fov {}", changes.fov));
  add(!changes.animation.empty(), "animation " + changes.animation);
  for (const std::string& setting : changes.setLight) add(true, setting);
  add(changes.defaultLights != none.defaultLights, "default lights " + changes.defaultLights);
  add(changes.environmentRotation != none.environmentRotation,
      fmt::format("environment rotation {}", changes.environmentRotation));
  add(changes.environmentScale != none.environmentScale,
      fmt::format("environment scale {}", changes.environmentScale));
  add(!changes.grid.empty(), "grid " + changes.grid);
  return text;
}

std::string question(const Case& c) {
  std::string text =
      fmt::format("{}/{}/{}/t{}/{}/{}x{}/spp{}/noise{}/bounces{}", c.scene, c.camera, c.light, c.time, c.term,
                  c.width, c.height, c.reference.spp, c.reference.noise, c.reference.bounces);
  if (c.reference.interfaces != 0) text += fmt::format("/interfaces{}", c.reference.interfaces);
  if (!c.environment.map.empty()) text += "/" + c.environment.map;
  if (c.lightSize > 0) text += fmt::format("/light size {}", c.lightSize);
  if (const std::string medium = describe(c.medium); !medium.empty()) text += "/" + medium;
  if (const std::string changes = describe(c.changes); !changes.empty()) text += "/" + changes;
  // All light together is asked of the map itself.
  if (!c.light.empty()) text += environmentLights(c.environment);
  return text;
}

std::string label(const Case& c) {
  const std::string timed =
      c.timeWidth > 0 ? fmt::format(" times at {}x{}", c.timeWidth, c.timeHeight) : std::string();
  std::string text =
      fmt::format("{}/{}/{}/{}/{}x{}{}/{}/{}", c.scene, c.camera.empty() ? "first camera" : c.camera,
                  c.light.empty() ? "all lights" : c.light, c.term, c.width, c.height, timed,
                  c.dynamic ? "dynamic" : "static", c.technique);
  if (!c.environment.map.empty())
    text = fmt::format("{}/{}", std::filesystem::path(c.environment.map).filename().string(), text);
  if (c.lightSize > 0) text = fmt::format("light size {}/{}", c.lightSize, text);
  if (c.fps > 0) text = fmt::format("{} fps/{}", c.fps, text);
  if (c.environment.lights > 0)
    text = fmt::format("environment lights {}/{}", environmentLights(c.environment), text);
  if (const std::string medium = describe(c.medium); !medium.empty()) text = medium + "/" + text;
  if (const std::string changes = describe(c.changes); !changes.empty()) text = changes + "/" + text;
  char separator = '?';
  for (const auto& [name, value] : c.parameters) {
    text += fmt::format("{}{}={}", separator, name, value);
    separator = '&';
  }
  return text;
}

std::string rowKey(const Case& c, std::string_view renderer) {
  // Separators that no name contains keep different cases different.
  std::string text = fmt::format("{}\x1f{}\x1f{}\x1f{}\x1f{}\x1f{}", question(c), c.technique, c.dynamic,
                                 c.frames, c.warmup, renderer);
  for (const auto& [name, value] : c.parameters) text += fmt::format("\x1e{}\x1f{}", name, value);
  if (c.timeWidth > 0) text += fmt::format("\x1d{}x{}", c.timeWidth, c.timeHeight);
  if (c.fps > 0) text += fmt::format("\x1b{}", c.fps);
  if (c.environment.lights > 0) text += "\x1c" + environmentLights(c.environment);
  return fmt::format("{:016x}", XXH3_64bits(text.data(), text.size()));
}

Shard parseShard(std::string_view text) {
  Shard shard;
  const std::size_t slash = text.find('/');
  const auto number = [&](std::string_view part, int& value) {
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
    return error == std::errc{} && end == part.data() + part.size();
  };
  if (slash == std::string_view::npos || !number(text.substr(0, slash), shard.index) ||
      !number(text.substr(slash + 1), shard.count) || shard.count < 1 || shard.index < 1 ||
      shard.index > shard.count) {
    throw UsageError(fmt::format("--shard '{}': i/n with 1 <= i <= n is accepted, such as 2/4", text));
  }
  return shard;
}

std::vector<Case> selectCases(std::span<const Case> cases, std::span<const std::string> filters,
                              Shard shard) {
  std::vector<Case> matching;
  for (const Case& c : cases) {
    const std::string text = label(c);
    if (std::all_of(filters.begin(), filters.end(),
                    [&](const std::string& filter) { return text.find(filter) != std::string::npos; })) {
      matching.push_back(c);
    }
  }
  std::map<std::string, int> questions;  // in order of appearance
  for (const Case& c : matching) questions.emplace(question(c), static_cast<int>(questions.size()));
  const bool byQuestion = static_cast<int>(questions.size()) >= shard.count;
  std::vector<Case> selected;
  for (std::size_t i = 0; i < matching.size(); ++i) {
    const int position = byQuestion ? questions[question(matching[i])] : static_cast<int>(i);
    if (position % shard.count == shard.index - 1) selected.push_back(matching[i]);
  }
  return selected;
}

}  // namespace limn::bench
