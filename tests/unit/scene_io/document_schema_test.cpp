// glTF 2.0's types, ranges and counts: each rule of the table by itself, and files written by hand.
#include "core/scene_io/private/document_schema.h"

#include <nlohmann/json.hpp>

#include "tests/support/scene_files.h"

namespace limn::test {
namespace {

using json = nlohmann::json;
using scene::PropertyRule;
using testing::AllOf;
using testing::HasSubstr;
using Type = PropertyRule::Type;

json goodValue(const PropertyRule& rule) {
  if (!rule.choices.empty())
    return rule.type == Type::text ? json(rule.choices[0]) : json(std::stoi(rule.choices[0]));
  switch (rule.type) {
    case Type::boolean:
      return true;
    case Type::text:
      return "x";
    case Type::number:
      return 0.5;
    case Type::whole:
      return static_cast<std::int64_t>(std::max(rule.low, 0.));
    case Type::object:
      return json::object();
  }
  return {};
}

/// Anything but what the rule accepts.
std::vector<json> wrongTypes(const PropertyRule& rule) {
  std::vector<json> values = {nullptr, json::array()};
  if (rule.type != Type::boolean) values.push_back(true);
  if (rule.type != Type::text) values.push_back("1");
  if (rule.type != Type::number) values.push_back(0.5);
  if (rule.type != Type::whole && rule.type != Type::number) values.push_back(1);
  if (rule.type != Type::object) values.push_back(json::object());
  return values;
}

/// The smallest document with `leaf` at the rule's path; arrays of any length get one element. `place`
/// becomes where it stands.
json documentWith(std::string path, const json& leaf, std::string& place, int extra = 0) {
  std::erase(path, '!');
  json root = json::object();
  json* at = &root;
  for (std::size_t i = 0; i < path.size();) {
    if (path[i] == '[') {
      const std::size_t close = path.find(']', i);
      const std::string count = path.substr(i + 1, close - i - 1);
      const int size = count.empty() ? 1 : std::stoi(count) + extra;
      *at = json::array();
      for (int k = 0; k < size; ++k) at->push_back(0.5);
      at = &(*at)[0];
      place += "[0]";
      i = close + 1;
    } else if (path[i] == '{') {
      at = &(*at)["POSITION"];
      place += ".POSITION";
      i += 2;
    } else {
      if (path[i] == '.') ++i;
      const std::size_t end = std::min(path.find_first_of(".[{", i), path.size());
      at = &(*at)[path.substr(i, end - i)];
      place += (place.empty() ? "" : ".") + path.substr(i, end - i);
      i = end;
    }
    if (at->is_number() && i < path.size()) *at = json();
  }
  *at = leaf;
  return root;
}

/// How far its range reaches beyond what a rule accepts, on either side.
std::vector<json> outOfRange(const PropertyRule& rule) {
  if (!rule.choices.empty())
    return {rule.type == Type::text ? json(rule.choices[0] + "X") : json(std::stoi(rule.choices[0]) + 7)};
  if (rule.type != Type::whole) return {};
  std::vector<json> values = {static_cast<std::int64_t>(rule.low) - 1};
  if (rule.high < 1e15) values.push_back(static_cast<std::int64_t>(rule.high) + 1);
  return values;
}

TEST(DocumentSchema, EveryPropertyTakesItsTypeAndNoOther) {
  for (const PropertyRule& rule : scene::propertyRules()) {
    std::string place;
    EXPECT_EQ(checkProperty(documentWith(rule.path, goodValue(rule), place), rule), "") << rule.path;
    for (const json& value : wrongTypes(rule)) {
      std::string where;
      const std::string problem = checkProperty(documentWith(rule.path, value, where), rule);
      EXPECT_THAT(problem, AllOf(HasSubstr(where + " is "), HasSubstr(accepted(rule) + " is accepted")))
          << rule.path << " " << value;
    }
  }
}

TEST(DocumentSchema, EveryRangeAndChoiceEnds) {
  int ranges = 0;
  for (const PropertyRule& rule : scene::propertyRules()) {
    for (const json& value : outOfRange(rule)) {
      std::string where;
      EXPECT_THAT(checkProperty(documentWith(rule.path, value, where), rule),
                  AllOf(HasSubstr(where + " is "), HasSubstr(accepted(rule) + " is accepted")))
          << rule.path << " " << value;
      ++ranges;
    }
  }
  EXPECT_GT(ranges, 50);
}

TEST(DocumentSchema, EveryCountIsKept) {
  int counts = 0;
  for (const PropertyRule& rule : scene::propertyRules()) {
    if (rule.path.find_first_of("0123456789") == std::string::npos || !rule.path.ends_with(']')) continue;
    for (const int extra : {-1, 1}) {
      std::string where;
      EXPECT_THAT(checkProperty(documentWith(rule.path, goodValue(rule), where, extra), rule),
                  HasSubstr("are accepted"))
          << rule.path;
    }
    ++counts;
  }
  EXPECT_GT(counts, 10);
}

TEST(DocumentSchema, WhatIsRequiredIsMissed) {
  int required = 0;
  for (const PropertyRule& rule : scene::propertyRules()) {
    const std::size_t mark = rule.path.rfind('!');
    if (mark == std::string::npos) continue;
    const std::size_t dot = rule.path.rfind('.', mark);
    std::string where;
    const json root = documentWith(rule.path.substr(0, dot), json::object(), where);
    EXPECT_THAT(checkProperty(root, rule),
                HasSubstr(where + rule.path.substr(dot, mark - dot) + " is missing"))
        << rule.path;
    ++required;
  }
  EXPECT_GT(required, 15);
}

/// A triangle with a material, its accessors and views written by hand.
GltfBuilder whole() {
  GltfBuilder b;
  const int material = b.append(
      "materials", {{"pbrMetallicRoughness", {{"metallicFactor", 1}, {"baseColorFactor", {1, 1, 1, 1}}}}});
  b.triangle(material);
  b.root["meshes"][0]["primitives"][0]["indices"] = b.indices({0, 1, 2});
  return b;
}

TEST(DocumentSchema, FilesThatOnceRenderedOtherPictures) {
  ASSERT_EQ(loadError(whole().glb()), "");
  const struct {
    const char* at;
    json value;
    const char* message;
  } cases[] = {
      {"/meshes/0/primitives/0/indices", -1,
       "meshes[0].primitives[0].indices is -1; a whole number in 0 .. "},
      {"/meshes/0/primitives/0/indices", "0", "meshes[0].primitives[0].indices is \"0\"; a whole number"},
      {"/meshes/0/primitives/0/material", -1, "meshes[0].primitives[0].material is -1"},
      {"/meshes/0/primitives/0/material", "a", "meshes[0].primitives[0].material is \"a\""},
      {"/meshes/0/primitives/0/mode", "4", "meshes[0].primitives[0].mode is \"4\"; a whole number in 0 .. 6"},
      {"/meshes/0/primitives/0/attributes/POSITION", "0",
       "meshes[0].primitives[0].attributes.POSITION is \"0\""},
      {"/nodes/0/mesh", -1, "nodes[0].mesh is -1"},
      {"/nodes/0/mesh", 0.0, "nodes[0].mesh is 0.0"},
      {"/nodes/0/translation", json::array({1, 2}), "nodes[0].translation has 2 elements; 3 are accepted"},
      {"/materials/0/pbrMetallicRoughness/metallicFactor", "1",
       "materials[0].pbrMetallicRoughness.metallicFactor is \"1\"; a number is accepted"},
      {"/materials/0/pbrMetallicRoughness/baseColorFactor", json::array({1, 0, 0}),
       "materials[0].pbrMetallicRoughness.baseColorFactor has 3 elements; 4 are accepted"},
      {"/materials/0/doubleSided", 1, "materials[0].doubleSided is 1; true or false is accepted"},
      {"/materials/0/alphaMode", "mask", "alphaMode is \"mask\"; OPAQUE, MASK or BLEND is accepted"},
      {"/bufferViews/0/byteOffset", -8,
       "bufferViews[0].byteOffset is -8; a whole number of at least 0 is accepted"},
      {"/accessors/0/normalized", "true", "accessors[0].normalized is \"true\""},
      {"/accessors/0/count", "3", "accessors[0].count is \"3\""},
      {"/materials/0/extensions", json{{"KHR_materials_ior", {{"ior", "2"}}}},
       "materials[0].extensions.KHR_materials_ior.ior is \"2\"; a number is accepted"},
  };
  for (const auto& c : cases) {
    GltfBuilder b = whole();
    b.root[json::json_pointer(c.at)] = c.value;
    EXPECT_THAT(loadError(b.glb()), HasSubstr(c.message)) << c.at << " " << c.value;
  }
}

TEST(DocumentSchema, WhatNoRuleNamesIsAllowed) {
  GltfBuilder b = whole();
  b.root["extensions"]["ANY_thing"] = {{"lights", "many"}};
  b.root["nodes"][0]["extras"] = 3;
  b.root["nodes"][0]["unknown"] = -1;
  b.root["materials"][0]["extensions"]["ANY_other"] = "x";
  EXPECT_EQ(loadError(b.glb()), "");
}

}  // namespace
}  // namespace limn::test
