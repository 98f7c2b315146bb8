// Reading a scene: the order of the steps, and what belongs to none of them.
#include "core/scene_io/load.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/text.h"
#include "core/scene/draw_instance.h"
#include "core/scene_io/density_grid_file.h"
#include "core/scene_io/private/loader.h"

namespace limn::scene {
Loader::Loader(std::string name, std::filesystem::path folder, const LoadLimits& limits)
    : name_(std::move(name)), folder_(std::move(folder)), limits_(limits) {}

void Loader::fail(const std::string& what) const {
  throw Error(oneLine(fmt::format("{}: {}", name_, what)));
}

void Loader::warn(const std::string& what) {
  // A damaged file could complain about each of a million things; nobody reads more than a screenful.
  constexpr std::size_t kMaxWarnings = 50;
  if (warned_.size() >= kMaxWarnings || !warned_.insert(what).second) return;
  scene_.warnings.push_back(oneLine(
      fmt::format("{}: {}", name_, warned_.size() == kMaxWarnings ? "more warnings left out" : what)));
}

void Loader::spend(std::uint64_t amount, const std::string& what) {
  if (amount > limits_.vertices - spent_)
    fail(fmt::format("{}: {} elements exceed the limit of {} in one scene", what, amount, limits_.vertices));
  spent_ += amount;
}

float Loader::number(double value, const std::string& what) const {
  if (!(std::abs(value) <= std::numeric_limits<float>::max()))
    fail(fmt::format("{}: {} is not a finite number", what, value));
  return static_cast<float>(value);
}

float Loader::ranged(double value, double low, double high, const std::string& what) {
  const float given = number(value, what);
  if (given >= low && given <= high) return given;
  // Rounding from double is no fault of the file.
  const float clamped = static_cast<float>(std::clamp<double>(given, low, high));
  if (std::abs(given - clamped) > 1e-6f * std::abs(clamped))
    warn(fmt::format("{}: {} is clamped to {}", what, given, clamped));
  return clamped;
}

std::vector<float> Loader::numbers(const tinygltf::Value& value, std::size_t count,
                                   const std::string& what) const {
  std::vector<float> out;
  for (std::size_t i = 0; i < value.ArrayLen(); ++i) {
    const tinygltf::Value& entry = value.Get(static_cast<int>(i));
    if (entry.IsNumber() && out.size() < count) out.push_back(number(entry.GetNumberAsDouble(), what));
  }
  if (out.size() != count || value.ArrayLen() != count)
    fail(fmt::format("{}: {} numbers are accepted", what, count));
  return out;
}

void Loader::readMedium(const tinygltf::Value& medium) {
  const std::string what = "limn_medium";
  if (!medium.IsObject()) fail(what + ": an object {sigma_a, sigma_s, g, grid, smoke} is accepted");
  const auto coefficient = [&](const char* key) {
    const tinygltf::Value& value = medium.Get(key);
    const std::string place = fmt::format("{} {}", what, key);
    glm::vec3 v(0);
    if (value.IsNumber()) {
      v = glm::vec3(number(value.GetNumberAsDouble(), place));
    } else if (medium.Has(key)) {
      const std::vector<float> rgb = numbers(value, 3, place);
      v = {rgb[0], rgb[1], rgb[2]};
    }
    if (v.x < 0 || v.y < 0 || v.z < 0)
      fail(fmt::format("{}: coefficients per metre must not be negative", place));
    return v;
  };
  scene_.medium.sigmaA = coefficient("sigma_a");
  scene_.medium.sigmaS = coefficient("sigma_s");
  for (int c = 0; c < 3; ++c)
    number(static_cast<double>(scene_.medium.sigmaA[c]) + scene_.medium.sigmaS[c],
           what + " sigma_a + sigma_s");
  if (medium.Has("g")) {
    const tinygltf::Value& g = medium.Get("g");
    if (!g.IsNumber()) fail(what + " g: a number is accepted");
    scene_.medium.g = number(g.GetNumberAsDouble(), what + " g");
  }
  if (!(std::abs(scene_.medium.g) < 1))
    fail(fmt::format("{} g: {}; more than -1 and less than 1 is accepted", what, scene_.medium.g));
  if (medium.Has("grid") && medium.Has("smoke"))
    fail(what + ": both a grid and smoke; one of them is accepted");
  if (medium.Has("smoke")) readSmoke(medium.Get("smoke"), what + " smoke");
  if (!medium.Has("grid")) return;
  const tinygltf::Value& grid = medium.Get("grid");
  if (!grid.IsString()) fail(what + " grid: the name of an OpenVDB file is accepted");
  const std::filesystem::path file = resolve(grid.Get<std::string>(), what + " grid");
  try {
    setGrid(scene_.medium, readDensityGrid(file, {}, scene_.origin));
  } catch (const Error& error) {
    fail(fmt::format("{} grid: {}", what, error.what()));
  }
  if (!scene_.medium.grid) warn(what + " grid: it is 0 everywhere; there is no medium");
}

void Loader::readSmoke(const tinygltf::Value& smoke, const std::string& what) {
  if (!smoke.IsObject()) fail(what + ": an object {low, high, whirl, rise, seed, resolution} is accepted");
  Smoke& s = scene_.medium.smoke.emplace();
  const auto corner = [&](const char* key) {
    const tinygltf::Value& xyz = smoke.Get(key);
    numbers(xyz, 3, fmt::format("{} {}", what, key));  // checks them
    glm::dvec3 place;
    for (int c = 0; c < 3; ++c) place[c] = xyz.Get(c).GetNumberAsDouble();
    return glm::vec3(place - scene_.origin);
  };
  s.low = corner("low");
  s.high = corner("high");
  const glm::vec3 extent = s.high - s.low;
  // Floats hold the squares of such sides.
  constexpr float least = 1e-18f, most = 1e18f;
  if (!glm::all(glm::greaterThan(extent, glm::vec3(least))) || !(glm::length(extent) < most))
    fail(what +
         ": low and high are corners of a box; each number of high is larger than that of low, by 1e-18 to "
         "1e18");
  const auto real = [&](const char* key, double low, double high, double otherwise) {
    if (!smoke.Has(key)) return static_cast<float>(otherwise);
    const tinygltf::Value& value = smoke.Get(key);
    const std::string place = fmt::format("{} {}", what, key);
    if (!value.IsNumber()) fail(place + ": a number is accepted");
    return ranged(value.GetNumberAsDouble(), low, high, place);
  };
  const double size = glm::length(extent);
  s.whirl = real("whirl", 1e-3 * size, 1e3 * size, 0.15 * size);
  s.rise = real("rise", -1e3 * size, 1e3 * size, 0);
  const auto whole = [&](const char* key, double low, double high, double otherwise) {
    const float value = real(key, low, high, otherwise);
    if (value != std::floor(value))
      fail(fmt::format("{} {}: {}; a whole number is accepted", what, key, value));
    return static_cast<int>(value);
  };
  s.seed = static_cast<uint32_t>(whole("seed", 0, 1e6, 0));
  s.resolution = whole("resolution", 2, 256, s.resolution);
}

void Loader::readSceneExtras() {
  const int chosen = std::max(model_->defaultScene, 0);
  if (static_cast<std::size_t>(chosen) >= model_->scenes.size()) return;
  const tinygltf::Value& extras = model_->scenes[static_cast<std::size_t>(chosen)].extras;
  if (!extras.IsObject()) return;
  if (extras.Has("limn_medium")) readMedium(extras.Get("limn_medium"));
  if (extras.Has("limn_environment")) {
    const tinygltf::Value& file = extras.Get("limn_environment");
    if (!file.IsString()) fail("limn_environment: the name of a file is accepted");
    scene_.environment =
        loadEnvironment(resolve(file.Get<std::string>(), "limn_environment"), scene_.warnings);
  }
}

Pose Loader::poseAtRest() const {
  try {
    return evaluate(scene_, 0);
  } catch (const Error& error) {
    fail(error.what());
  }
}

void Loader::checkResult() {
  const Pose pose = poseAtRest();
  std::size_t lights = 0;
  for (const Node& node : scene_.nodes) lights += node.light != kNone ? 1 : 0;
  for (const DrawInstance& instance : pose.instances)
    if (instance.node != kNone) lights += primitiveOf(scene_, pose, instance).emissiveParts.size();
  if (pose.lights.size() < lights)
    warn("emissive rectangles that their nodes skew are displayed but light nothing");
}

Scene Loader::load(std::span<const std::byte> bytes) {
  tinygltf::Model model;
  model_ = &model;
  parse(openContainer(bytes, name_), model);
  readMaterials();
  readMeshes();
  readLights();
  readCameras();
  readNodes();
  readMetaballs();
  readSkins();
  checkNodeUses();
  readAnimations();
  moveOrigin();
  readSceneExtras();
  checkResult();
  model_ = nullptr;
  return std::move(scene_);
}

Scene load(const std::filesystem::path& file, const LoadLimits& limits) {
  const std::vector<std::byte> bytes = readFile(file);
  std::filesystem::path folder = file.parent_path();
  if (folder.empty()) folder = ".";
  Scene scene = Loader(file.string(), folder, limits).load(bytes);
  scene.file = file;
  return scene;
}

Scene loadMemory(std::span<const std::byte> bytes, const LoadLimits& limits) {
  return Loader("scene", {}, limits).load(bytes);
}

}  // namespace limn::scene
