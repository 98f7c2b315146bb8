// Reads bench suites. Every complaint names file, line and column.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <set>
#include <tuple>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/bench/suite.h"

namespace limn::bench {
namespace {

constexpr std::size_t kMaxCases = 100000;
constexpr const char* kTerms[] = {"final", "visibility", "direct", "indirect", "caustic", "media"};

[[noreturn]] void fail(const std::string& file, const toml::source_region& where,
                       const std::string& message) {
  throw UsageError(fmt::format("{}:{}:{}: {}", file, where.begin.line, where.begin.column, message));
}

/// A TOML table whose keys must all be read.
class Section {
 public:
  Section(const std::string& file, const toml::table& table, std::string name,
          std::initializer_list<const char*> keys)
      : file_(file), table_(table), name_(std::move(name)) {
    for (const auto& [key, node] : table) {
      if (std::find(keys.begin(), keys.end(), key.str()) == keys.end()) {
        fail(file_, key.source(),
             fmt::format("unknown key '{}' in {}; known are {}", key.str(), name_, fmt::join(keys, ", ")));
      }
    }
  }

  const std::string& file() const { return file_; }
  const toml::node* find(const char* key) const { return table_.get(key); }

  [[noreturn]] void failAt(const toml::node& node, const std::string& message) const {
    fail(file_, node.source(), message);
  }

  const toml::node& require(const char* key) const {
    const toml::node* node = find(key);
    if (node == nullptr) fail(file_, table_.source(), fmt::format("{} lacks the key '{}'", name_, key));
    return *node;
  }

  std::string text(const toml::node& node, const char* key) const {
    const auto value = node.value_exact<std::string>();
    if (!value || value->empty()) failAt(node, fmt::format("'{}' must be a text that is not empty", key));
    return *value;
  }

  std::string text(const char* key, const std::string& otherwise) const {
    const toml::node* node = find(key);
    return node == nullptr ? otherwise : text(*node, key);
  }

  int integer(const char* key, int otherwise, int low, int high) const {
    const toml::node* node = find(key);
    if (node == nullptr) return otherwise;
    const auto value = node->value_exact<std::int64_t>();
    if (!value || *value < low || *value > high) {
      failAt(*node, fmt::format("'{}' must be a whole number in {}..{}", key, low, high));
    }
    return static_cast<int>(*value);
  }

  double real(const char* key, double otherwise, double low, double high) const {
    const toml::node* node = find(key);
    if (node == nullptr) return otherwise;
    const auto value = node->value<double>();
    if (!value || !node->is_number() || !(*value >= low && *value <= high)) {
      failAt(*node, fmt::format("'{}' must be a number in {}..{}", key, low, high));
    }
    return *value;
  }

  /// One number or a list of them.
  std::vector<double> reals(const char* key, double otherwise, double low, double high) const {
    const toml::node* node = find(key);
    if (node == nullptr || !node->is_array()) return {real(key, otherwise, low, high)};
    if (node->as_array()->empty()) failAt(*node, fmt::format("'{}' is an empty list", key));
    std::vector<double> values;
    for (const toml::node& element : *node->as_array()) {
      const auto value = element.value<double>();
      if (!value || !element.is_number() || !(*value >= low && *value <= high))
        failAt(element, fmt::format("'{}' must be numbers in {}..{}", key, low, high));
      values.push_back(*value);
    }
    return values;
  }

  /// One of `known`, the first where the key is missing.
  std::string choice(const char* key, std::initializer_list<const char*> known) const {
    const std::string value = text(key, *known.begin());
    if (std::find(known.begin(), known.end(), value) == known.end())
      failAt(*find(key), fmt::format("unknown {} '{}'; known are {}", key, value, fmt::join(known, ", ")));
    return value;
  }

  bool boolean(const char* key, bool otherwise) const {
    const toml::node* node = find(key);
    if (node == nullptr) return otherwise;
    const auto value = node->value_exact<bool>();
    if (!value) failAt(*node, fmt::format("'{}' must be true or false", key));
    return *value;
  }

  /// One text or a list of them.
  std::vector<std::string> texts(const char* key, std::vector<std::string> otherwise) const {
    const toml::node* node = find(key);
    if (node == nullptr) return otherwise;
    if (!node->is_array()) return {text(*node, key)};
    if (node->as_array()->empty()) failAt(*node, fmt::format("'{}' is an empty list", key));
    std::vector<std::string> values;
    for (const toml::node& element : *node->as_array()) values.push_back(text(element, key));
    return values;
  }

  std::string term(const std::string& otherwise) const {
    const std::string value = text("term", otherwise);
    if (std::find(std::begin(kTerms), std::end(kTerms), value) == std::end(kTerms)) {
      failAt(*find("term"), fmt::format("unknown term '{}'; known are {}", value, fmt::join(kTerms, ", ")));
    }
    return value;
  }

  /// The tables of an array of tables, which must be there.
  std::vector<const toml::table*> tables(const char* key) const {
    const toml::node& node = require(key);
    const toml::array* array = node.as_array();
    if (array == nullptr || array->empty())
      failAt(node, fmt::format("'{}' must be tables: [[{}]]", key, key));
    std::vector<const toml::table*> result;
    for (const toml::node& element : *array) {
      if (!element.is_table()) failAt(element, fmt::format("'{}' must be tables: [[{}]]", key, key));
      result.push_back(element.as_table());
    }
    return result;
  }

 private:
  std::string file_;
  const toml::table& table_;
  std::string name_;
};

std::pair<int, int> parseSize(const Section& section, const toml::node& node, const char* key = "sizes") {
  const std::string text = section.text(node, key);
  int width = 0, height = 0, used = 0;
  if (std::sscanf(text.c_str(), "%5dx%5d%n", &width, &height, &used) != 2 ||
      used != static_cast<int>(text.size()) || width < 1 || height < 1 || width > 16384 || height > 16384) {
    section.failAt(node, fmt::format("size '{}': WIDTHxHEIGHT with 1..16384 pixels is accepted", text));
  }
  return {width, height};
}

std::vector<std::pair<int, int>> parseSizes(const Section& section) {
  const toml::node& node = section.require("sizes");
  if (!node.is_array()) return {parseSize(section, node)};
  if (node.as_array()->empty()) section.failAt(node, "'sizes' is an empty list");
  std::vector<std::pair<int, int>> sizes;
  for (const toml::node& element : *node.as_array()) sizes.push_back(parseSize(section, element));
  return sizes;
}

ReferenceSettings parseReference(const Section& suite) {
  const toml::node* node = suite.find("reference");
  ReferenceSettings settings;
  if (node == nullptr) return settings;
  if (!node->is_table()) suite.failAt(*node, "'reference' must be a table such as {spp = 256}");
  const Section section(suite.file(), *node->as_table(), "reference", {"spp", "noise", "bounces"});
  settings.noise = section.real("noise", 0.0, 0.0, 1.0);
  settings.spp = section.integer("spp", settings.noise > 0.0 ? 1 << 20 : settings.spp, 1, 1 << 24);
  settings.bounces = section.integer("bounces", settings.bounces, 0, 64);
  return settings;
}

std::vector<bool> parseModes(const Section& suite) {
  std::vector<bool> modes;
  for (const std::string& mode : suite.texts("modes", {"dynamic"})) {
    if (mode != "dynamic" && mode != "static") {
      suite.failAt(*suite.find("modes"), fmt::format("unknown mode '{}'; known are dynamic, static", mode));
    }
    modes.push_back(mode == "dynamic");
  }
  return modes;
}

/// A parameter's value as the command line takes it.
std::string valueText(const Section& section, const toml::node& node, const std::string& name) {
  if (const auto text = node.value_exact<std::string>()) return *text;
  if (const auto flag = node.value_exact<bool>()) return *flag ? "true" : "false";
  if (const auto whole = node.value_exact<std::int64_t>()) return fmt::format("{}", *whole);
  if (const auto number = node.value_exact<double>(); number && std::isfinite(*number)) {
    return fmt::format("{}", *number);
  }
  section.failAt(
      node, fmt::format("parameter '{}' must be a number, a text, true or false, or a list of these", name));
}

struct SweptTechnique {
  std::string name, title;
  bool baseline = false;
  std::vector<std::vector<std::pair<std::string, std::string>>> settings;  // all combinations
};

SweptTechnique parseTechnique(const std::string& file, const toml::table& table) {
  const Section section(file, table, "[[techniques]]", {"technique", "parameters", "label", "baseline"});
  SweptTechnique technique{section.text(section.require("technique"), "technique"),
                           section.text("label", ""),
                           section.boolean("baseline", false),
                           {{}}};
  const toml::node* parameters = section.find("parameters");
  if (parameters == nullptr) return technique;
  if (!parameters->is_table()) section.failAt(*parameters, "'parameters' must be a table");
  for (const auto& [key, node] : *parameters->as_table()) {
    std::string name(key.str());
    if (name.find('.') == std::string::npos) {
      if (technique.name.find(',') != std::string::npos) {
        fail(file, key.source(),
             fmt::format("parameter '{}' of a combination must be written \"technique.parameter\"", name));
      }
      name = fmt::format("{}.{}", technique.name, name);
    }
    std::vector<std::string> values;
    if (const toml::array* list = node.as_array()) {
      if (list->empty()) section.failAt(node, fmt::format("parameter '{}' has an empty list", name));
      for (const toml::node& element : *list) values.push_back(valueText(section, element, name));
    } else {
      values.push_back(valueText(section, node, name));
    }
    decltype(technique.settings) combined;
    for (const auto& setting : technique.settings) {
      for (const std::string& value : values) {
        combined.push_back(setting);
        combined.back().emplace_back(name, value);
      }
    }
    if (combined.size() > kMaxCases)
      section.failAt(node, fmt::format("more than {} combinations", kMaxCases));
    technique.settings = std::move(combined);
  }
  return technique;
}

/// All but the threshold, of which there may be several.
std::vector<double> parseEnvironment(const Section& scene, EnvironmentSettings& environment) {
  environment = {};
  environment.map = scene.text("environment", "");
  environment.resolution = scene.integer("environment_resolution", environment.resolution, 1, 512);
  environment.shape = scene.choice("environment_shape", {"squares", "rectangles"});
  environment.reflection = scene.choice("environment_reflection", {"area", "centre"});
  std::vector<double> thresholds = scene.reals("environment_lights", 0, 0, 0.5);
  if (environment.map.empty() && scene.find("environment_lights") != nullptr)
    scene.failAt(*scene.find("environment_lights"), "'environment_lights' needs an 'environment'");
  return thresholds;
}

/// All cases that ask one question of every technique.
void addCases(const Case& base, const std::vector<SweptTechnique>& techniques, const std::vector<bool>& modes,
              bool separationFloor, std::vector<Case>& cases) {
  if (separationFloor && base.term == "direct") {
    for (const bool dynamic : modes) {
      cases.push_back(base);
      cases.back().technique = kSeparationFloor;
      cases.back().dynamic = dynamic;
    }
  }
  for (const SweptTechnique& technique : techniques) {
    for (const auto& setting : technique.settings) {
      for (const bool dynamic : modes) {
        cases.push_back(base);
        cases.back().technique = technique.name;
        cases.back().parameters = setting;
        cases.back().title = technique.title;
        cases.back().baseline = technique.baseline;
        cases.back().dynamic = dynamic;
      }
    }
  }
}

Suite parse(std::string_view text, const std::string& file, bool mayInclude);

/// The cases of other suites, files beside this one that include none themselves.
std::vector<Case> includedCases(const Section& suite, bool mayInclude) {
  std::vector<Case> cases;
  if (!mayInclude && suite.find("include") != nullptr)
    suite.failAt(*suite.find("include"), "an included suite includes others; one level is enough");
  for (const std::string& name : suite.texts("include", {})) {
    const std::filesystem::path path = std::filesystem::path(suite.file()).parent_path() / name;
    if (std::filesystem::path(name).filename() != name)
      suite.failAt(*suite.find("include"),
                   fmt::format("'{}' is not the name of a file beside the suite", name));
    const Suite included = parse(readTextFile(path, 1 << 24), path.string(), false);
    cases.insert(cases.end(), included.cases.begin(), included.cases.end());
  }
  std::set<std::string> keys;
  std::erase_if(cases, [&](const Case& c) { return !keys.insert(rowKey(c, "")).second; });
  return cases;
}

/// The scenes and techniques of the file itself.
void addOwnCases(const Section& suite, std::vector<Case>& cases) {
  const std::string& file = suite.file();
  Case base;
  base.frames = suite.integer("frames", 20, 0, 100000);
  base.warmup = suite.integer("warmup", 3, 0, 100000);
  base.reference = parseReference(suite);
  base.picture = suite.boolean("pictures", false);
  if (const toml::node* node = suite.find("time_size"))
    std::tie(base.timeWidth, base.timeHeight) = parseSize(suite, *node, "time_size");
  const std::string term = suite.term("final");
  const auto sizes = parseSizes(suite);
  const std::vector<bool> modes = parseModes(suite);
  const bool separationFloor = suite.boolean("separation_floor", false);
  std::vector<SweptTechnique> techniques;
  for (const toml::table* table : suite.tables("techniques"))
    techniques.push_back(parseTechnique(file, *table));

  for (const toml::table* table : suite.tables("scenes")) {
    const Section scene(
        file, *table, "[[scenes]]",
        {"scene", "cameras", "lights", "light_sizes", "time", "term", "max_masked_share", "environment",
         "environment_lights", "environment_resolution", "environment_shape", "environment_reflection"});
    base.scene = scene.text(scene.require("scene"), "scene");
    base.time = scene.real("time", 0.0, -1e6, 1e6);
    base.maxMaskedShare = scene.real("max_masked_share", 0.005, 0.0, 1.0);
    base.term = scene.term(term);
    const std::vector<double> lightSizes = scene.reals("light_sizes", 0, 1e-6, 1e6);
    const std::vector<double> environmentLights = parseEnvironment(scene, base.environment);
    for (const std::string& camera : scene.texts("cameras", {""})) {
      for (const std::string& light : scene.texts("lights", {""})) {
        for (const auto& [width, height] : sizes) {
          base.camera = camera;
          base.light = light;
          base.width = width;
          base.height = height;
          for (const double lightSize : lightSizes) {
            base.lightSize = lightSize;
            for (const double threshold : environmentLights) {
              base.environment.lights = threshold;
              addCases(base, techniques, modes, separationFloor, cases);
            }
          }
          if (cases.size() > kMaxCases) {
            fail(file, table->source(), fmt::format("more than {} cases", kMaxCases));
          }
        }
      }
    }
  }
}

Suite buildSuite(const toml::table& root, const std::string& file, bool mayInclude) {
  const Section suite(file, root, "the suite",
                      {"name", "minutes", "include", "sizes", "time_size", "frames", "warmup", "modes",
                       "term", "reference", "separation_floor", "pictures", "scenes", "techniques"});
  Suite result{suite.text(suite.require("name"), "name"), suite.real("minutes", 0, 0, 1e6),
               includedCases(suite, mayInclude)};
  if (suite.find("include") == nullptr || suite.find("scenes") != nullptr) addOwnCases(suite, result.cases);
  std::set<std::string> keys;
  for (const Case& c : result.cases) {
    if (!keys.insert(rowKey(c, "")).second) {
      throw UsageError(fmt::format("{}: the same case twice: {}", file, label(c)));
    }
  }
  return result;
}

Suite parse(std::string_view text, const std::string& file, bool mayInclude) {
  try {
    return buildSuite(toml::parse(text), file, mayInclude);
  } catch (const toml::parse_error& error) {
    fail(file, error.source(), std::string(error.description()));
  }
}

}  // namespace

Suite parseSuite(std::string_view text, const std::string& fileName) {
  return parse(text, fileName, true);
}

Suite readSuite(const std::filesystem::path& path) {
  return parseSuite(readTextFile(path, 1 << 24), path.string());
}

}  // namespace limn::bench
