// Reads bench suites. Every complaint names file, line and column.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <tuple>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/text.h"
#include "core/bench/private/question_toml.h"
#include "core/bench/private/toml_nesting.h"
#include "core/bench/private/toml_section.h"
#include "core/bench/suite.h"
#include "core/question/question_fields.h"
#include "core/question/technique_names.h"
#include "core/question/term.h"
#include "core/reference/reference.h"

namespace limn::bench {
namespace {

constexpr std::size_t kMaxCases = 100000;
// Bytes of the texts of all cases: each holds those of its scene and its parameters, however long.
constexpr std::size_t kMaxText = std::size_t{256} << 20;
constexpr const char* kTooMuchText = "more than 256 MiB of text in all combinations";

/// The bytes that a parameter takes in each case.
std::size_t bytesOf(const std::string& name, const std::string& value) {
  return sizeof(std::pair<std::string, std::string>) + name.size() + value.size();
}

/// The bytes that a case takes beside its question.
std::size_t bytesOf(const Case& c) {
  std::size_t bytes = c.technique.size() + c.title.size();
  for (const auto& [name, value] : c.parameters) bytes += bytesOf(name, value);
  return bytes;
}

/// A number or "all"; 0 where nothing is said of them.
int parseInterfaces(const TomlSection& section) {
  const toml::node* node = section.find("interfaces");
  if (node != nullptr && node->value_exact<std::string>() == "all") return reference::kAllInterfaces;
  return section.integer("interfaces", 0, 1, reference::kMaxInterfaces);
}

/// Bounces and interfaces: 0 where nothing is said of them.
ReferenceSettings parseReference(const TomlSection& suite) {
  const toml::node* node = suite.find("reference");
  ReferenceSettings settings;
  settings.bounces = 0;
  if (node == nullptr) return settings;
  if (!node->is_table()) suite.fail(*node, "'reference' must be a table such as {spp = 256}");
  const TomlSection section(suite.file(), *node->as_table(), "reference",
                            {"spp", "noise", "bounces", "interfaces"});
  settings.noise = section.real("noise", 0.0, 0.0, 1.0);
  settings.spp = section.integer("spp", settings.noise > 0.0 ? 1 << 20 : settings.spp, 1, 1 << 24);
  settings.bounces = section.integer("bounces", 0, 1, reference::kMaxBounces);
  settings.interfaces = parseInterfaces(section);
  return settings;
}

/// What the suite says of references, where the term has it.
ReferenceSettings referenceOf(ReferenceSettings given, Term term) {
  if (!reference::hasBounces(term))
    given.bounces = 1;
  else if (given.bounces == 0)
    given.bounces = reference::defaultBounces(term);
  if (!reference::acceptsInterfaces(term, given.interfaces))
    given.interfaces = reference::defaultInterfaces(term);
  return given;
}

std::string listed(TermSet terms) {
  return fmt::format("{}", fmt::join(termNames(terms), ", "));
}

/// Rejects `bounces` or `interfaces` where no case's term has them.
void checkReference(const TomlSection& suite, std::span<const Case> cases) {
  const toml::node* reference = suite.find("reference");
  const auto given = [&](const char* key) { return reference ? reference->as_table()->get(key) : nullptr; };
  const toml::node* bounces = given("bounces");
  if (bounces &&
      std::ranges::none_of(cases, [](const Case& c) { return reference::hasBounces(parseTerm(c.term)); }))
    suite.fail(
        *bounces,
        fmt::format("no scene asks for a term that has 'bounces': {}",
                    listed(termsWhere([](const TermInfo& t) { return t.bounces != TermBounces::none; }))));
  const toml::node* interfaces = given("interfaces");
  if (!interfaces || std::ranges::any_of(cases, [](const Case& c) { return c.reference.interfaces != 0; }))
    return;
  constexpr TermSet light =
      termsWhere([](const TermInfo& t) { return t.interfaces == TermInterfaces::light; });
  constexpr TermSet seen =
      termsWhere([](const TermInfo& t) { return t.interfaces != TermInterfaces::none; }) & ~light;
  suite.fail(*interfaces,
             fmt::format("no scene asks for a term that has these 'interfaces': {}; with \"all\" {}, too",
                         listed(seen), listed(light)));
}

std::vector<bool> parseModes(const TomlSection& suite) {
  std::vector<bool> modes;
  for (const std::string& mode : suite.texts("modes", {"dynamic"})) {
    if (mode != "dynamic" && mode != "static") {
      suite.fail(*suite.find("modes"), fmt::format("unknown mode '{}'; known are dynamic, static", mode));
    }
    modes.push_back(mode == "dynamic");
  }
  return modes;
}

/// A parameter's value as the command line takes it.
std::string valueText(const TomlSection& section, const toml::node& node, const std::string& name) {
  if (const auto text = node.value_exact<std::string>(); text && text->empty()) return *text;
  if (node.is_string()) return section.text(node, name.c_str());
  if (const auto flag = node.value_exact<bool>()) return *flag ? "true" : "false";
  if (const auto whole = node.value_exact<std::int64_t>()) return fmt::format("{}", *whole);
  if (const auto number = node.value_exact<double>(); number && std::isfinite(*number)) {
    return fmt::format("{}", *number);
  }
  section.fail(
      node, fmt::format("parameter '{}' must be a number, a text, true or false, or a list of these", name));
}

struct SweptTechnique {
  std::string name, title;
  bool baseline = false;
  std::vector<std::vector<std::pair<std::string, std::string>>> settings;  // all combinations
  std::size_t text = 0;                                                    // of these, bytes
};

SweptTechnique parseTechnique(const std::string& file, const toml::table& table) {
  const TomlSection section(file, table, "[[techniques]]", {"technique", "parameters", "label", "baseline"});
  SweptTechnique technique{section.text(section.require("technique"), "technique"),
                           section.text("label", ""),
                           section.boolean("baseline", false),
                           {{}},
                           0};
  if (technique.name == kSeparationFloor)
    section.fail(*section.find("technique"),
                 fmt::format("{0} is no technique; the suite's key {0} adds its rows", kSeparationFloor));
  const toml::node* parameters = section.find("parameters");
  if (parameters == nullptr) return technique;
  if (!parameters->is_table()) section.fail(*parameters, "'parameters' must be a table");
  std::set<std::string> names;
  for (const auto& [key, node] : *parameters->as_table()) {
    std::string name(key.str());
    if (oneLine(name, name.size()) != name) failAt(file, key.source(), "a parameter's name must be one line");
    if (name.find('.') == std::string::npos) {
      if (technique.name.find(',') != std::string::npos) {
        failAt(file, key.source(),
               fmt::format("parameter '{}' of a combination must be written \"technique.parameter\"", name));
      }
      const std::vector<NamedTechnique> named = namedTechniques(technique.name);
      name = fmt::format("{}.{}", named.empty() ? "" : named.front().name, name);
    }
    if (!names.insert(name).second)
      failAt(file, key.source(), fmt::format("parameter '{}' is set twice", name));
    std::vector<std::string> values;
    if (const toml::array* list = node.as_array()) {
      if (list->empty()) section.fail(node, fmt::format("parameter '{}' has an empty list", name));
      for (const toml::node& element : *list) values.push_back(valueText(section, element, name));
    } else {
      values.push_back(valueText(section, node, name));
    }
    if (technique.settings.size() * values.size() > kMaxCases)
      section.fail(node, fmt::format("more than {} combinations", kMaxCases));
    std::size_t added = 0;
    for (const std::string& value : values) added += bytesOf(name, value);
    technique.text = technique.text * values.size() + technique.settings.size() * added;
    if (technique.text > kMaxText) section.fail(node, kTooMuchText);
    decltype(technique.settings) combined;
    for (const auto& setting : technique.settings) {
      for (const std::string& value : values) {
        combined.push_back(setting);
        combined.back().emplace_back(name, value);
      }
    }
    technique.settings = std::move(combined);
  }
  return technique;
}

std::vector<SweptTechnique> parseTechniques(const TomlSection& suite) {
  std::vector<SweptTechnique> techniques;
  std::size_t settings = 0, text = 0;
  for (const toml::table* table : suite.tables("techniques")) {
    techniques.push_back(parseTechnique(suite.file(), *table));
    settings += techniques.back().settings.size();
    text += techniques.back().text;
    if (settings > kMaxCases)
      failAt(suite.file(), table->source(), fmt::format("more than {} combinations", kMaxCases));
    if (text > kMaxText) failAt(suite.file(), table->source(), kTooMuchText);
  }
  return techniques;
}

/// All cases that ask one question of every technique, one after the other.
template <class Add>
void forEachCase(const Case& question, const std::vector<SweptTechnique>& techniques,
                 const std::vector<bool>& modes, bool separationFloor, Add add) {
  Case c = question;
  const auto addModes = [&] {
    for (const bool dynamic : modes) {
      c.dynamic = dynamic;
      add(c);
    }
  };
  if (separationFloor && c.term == name(Term::direct)) {
    c.technique = kSeparationFloor;
    addModes();
  }
  for (const SweptTechnique& technique : techniques) {
    c.technique = technique.name;
    c.title = technique.title;
    c.baseline = technique.baseline;
    for (const auto& setting : technique.settings) {
      c.parameters = setting;
      addModes();
    }
  }
}

Suite parse(std::string_view text, const std::string& file, bool mayInclude);

/// The cases of other suites, files beside this one that include none themselves.
std::vector<Case> includedCases(const TomlSection& suite, bool mayInclude) {
  std::vector<Case> cases;
  std::set<std::string> files, keys;
  if (!mayInclude && suite.find("include") != nullptr)
    suite.fail(*suite.find("include"), "an included suite includes others; one level is enough");
  for (const std::string& name : suite.texts("include", {})) {
    if (!files.insert(name).second) continue;
    const std::filesystem::path path = std::filesystem::path(suite.file()).parent_path() / name;
    if (std::filesystem::path(name).filename() != name)
      suite.fail(*suite.find("include"),
                 fmt::format("'{}' is not the name of a file beside the suite", name));
    const Suite included = parse(readTextFile(path, 1 << 24), path.string(), false);
    std::ranges::copy_if(included.cases, std::back_inserter(cases),
                         [&](const Case& c) { return keys.insert(rowKey(c, "")).second; });
    if (cases.size() > kMaxCases)
      suite.fail(*suite.find("include"), fmt::format("more than {} cases", kMaxCases));
  }
  return cases;
}

/// The scenes and techniques of the file itself.
void addOwnCases(const TomlSection& suite, std::vector<Case>& cases) {
  const std::string& file = suite.file();
  Case base;
  base.frames = suite.integer("frames", 20, 0, 100000);
  base.warmup = suite.integer("warmup", 3, 0, 100000);
  base.turns = suite.integer("turns", 1, 1, 1000);
  const ReferenceSettings references = parseReference(suite);
  const std::size_t before = cases.size();
  base.picture = suite.boolean("pictures", false);
  base.bound = suite.boolean("bound", false);
  if (const toml::node* node = suite.find("time_size"))
    std::tie(base.timeWidth, base.timeHeight) = parseSize(suite, *node, "time_size");
  const std::string term = readTerm(suite, name(Term::final));
  const auto sizes = parseSizes(suite);
  const std::vector<bool> modes = parseModes(suite);
  const bool separationFloor = suite.boolean("separation_floor", false);
  const std::vector<SweptTechnique> techniques = parseTechniques(suite);

  std::vector<const char*> sceneKeys = questionKeys();
  sceneKeys.insert(sceneKeys.end(), {"fps", "max_masked_share"});
  std::size_t text = 0;
  for (const toml::table* table : suite.tables("scenes")) {
    const TomlSection scene(file, *table, "[[scenes]]", sceneKeys);
    base.fps = scene.real("fps", 0.0, 0.0, 1e6);
    base.maxMaskedShare = scene.real("max_masked_share", 0.005, 0.0, 1.0);
    base.reference = referenceOf(references, parseTerm(readTerm(scene, term)));
    forEachQuestion(scene, sizes, term, [&](const SceneQuestion& question) {
      static_cast<SceneQuestion&>(base) = question;
      const std::size_t asked = questionText(question).size();
      forEachCase(base, techniques, modes, separationFloor, [&](const Case& c) {
        text += asked + bytesOf(c);
        if (cases.size() == kMaxCases)
          failAt(file, table->source(), fmt::format("more than {} cases", kMaxCases));
        if (text > kMaxText) failAt(file, table->source(), kTooMuchText);
        cases.push_back(c);
      });
    });
  }
  checkReference(suite, std::span(cases).subspan(before));
}

Suite buildSuite(const toml::table& root, const std::string& file, bool mayInclude) {
  const TomlSection suite(file, root, "the suite",
                          {"name", "about", "minutes", "stall_timeout", "include", "sizes", "time_size",
                           "frames", "warmup", "turns", "modes", "term", "reference", "separation_floor",
                           "pictures", "bound", "scenes", "techniques"});
  Suite result{suite.text(suite.require("name"), "name"), suite.text("about", ""),
               suite.real("minutes", 0, 0, 1e6), suite.real("stall_timeout", 1800, 0, 1e6),
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
  checkTomlNesting(text, file);
  try {
    return buildSuite(toml::parse(text), file, mayInclude);
  } catch (const toml::parse_error& error) {
    failAt(file, error.source(), std::string(error.description()));
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
