// The scenes of reflection models as written to disk: what extras.limn_material says, the glTF values beside
// it, and the tangents that anisotropic models need.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/glb.h"

namespace limn::test {
namespace {

using nlohmann::json;

const char* const kMaterialScenes[] = {"disk_and_sphere",  "fresnel_spheres", "glossy_torus",
                                       "measured_spheres", "robot_brdfs",     "teapot_groove",
                                       "torus_metal"};

/// The object of a material's extras, or null.
json modelOf(const json& material) {
  return material.value("extras", json::object()).value("limn_material", json());
}

double dot(const Vec3& a, const Vec4& b) {
  return static_cast<double>(a[0]) * b[0] + static_cast<double>(a[1]) * b[1] +
         static_cast<double>(a[2]) * b[2];
}

/// One channel of what stands for one number, two or three.
double channel(const json& value, std::size_t c) {
  return value.is_array() ? value.at(c).get<double>() : value.get<double>();
}

/// Fresnel's equations at normal incidence: |(n + ik - 1) / (n + ik + 1)|^2.
double normalReflectance(double n, double k) {
  return ((n - 1) * (n - 1) + k * k) / ((n + 1) * (n + 1) + k * k);
}

json material(const Glb& glb, const std::string& name) {
  const json& all = glb.root.at("materials");
  const auto found = std::ranges::find_if(all, [&](const json& m) { return m.at("name") == name; });
  EXPECT_NE(found, all.end()) << name;
  return found == all.end() ? json() : *found;
}

/// The only primitive of the mesh of that name.
json primitive(const Glb& glb, const std::string& name) {
  const json& all = glb.root.at("meshes");
  const auto found = std::ranges::find_if(all, [&](const json& m) { return m.at("name") == name; });
  EXPECT_NE(found, all.end()) << name;
  return found == all.end() ? json() : found->at("primitives").at(0);
}

/// assets/README.md: how many numbers a key takes at most, and between which bounds; or which words.
struct Rule {
  std::size_t numbers = 0;
  double low = 0, high = 0;
  std::set<std::string> words = {};
};

const std::map<std::string, Rule>& rules() {
  static const std::map<std::string, Rule> table = {
      {"model", {.words = {"torrance_sparrow", "ward", "banks", "phong", "coated", "measured"}}},
      {"roughness", {2, 0, 1}},
      {"eta", {3, 1e-3, 1000}},
      {"k", {3, 0, 1000}},
      {"kd", {3, 0, 1}},
      {"ks", {3, 0, 1}},
      {"exponent", {1, 0, 1e6}},
      {"file", {}},
      {"distribution", {.words = {"beckmann", "gaussian"}}},
      {"masking", {.words = {"correlated", "product"}}},
      {"banks", {.words = {"stalling", "printed"}}},
      {"combine", {.words = {"sum", "blend", "physical"}}}};
  return table;
}

TEST(MaterialScenes, ModelsAreDescribedAsTheReadmeSays) {
  std::set<std::string> models;
  for (const char* scene : kMaterialScenes) {
    const Glb glb(scene);
    for (const json& m : glb.root.at("materials")) {
      const json model = modelOf(m);
      if (model.is_null()) continue;
      SCOPED_TRACE(std::string(scene) + " " + m.at("name").get<std::string>());
      ASSERT_TRUE(model.contains("model"));
      models.insert(model.at("model").get<std::string>());
      for (const auto& [key, value] : model.items()) {
        const auto rule = rules().find(key);
        ASSERT_NE(rule, rules().end()) << key;
        if (key == "file") {
          EXPECT_TRUE(std::filesystem::exists(kAssets / scene / value.get<std::string>())) << value;
          continue;
        }
        if (!rule->second.words.empty()) {
          EXPECT_TRUE(value.is_string() && rule->second.words.count(value.get<std::string>())) << value;
          continue;
        }
        EXPECT_TRUE(value.is_number() || (value.is_array() && value.size() == rule->second.numbers)) << key;
        for (std::size_t c = 0; c < (value.is_array() ? value.size() : 1); ++c) {
          EXPECT_GE(channel(value, c), rule->second.low) << key;
          EXPECT_LE(channel(value, c), rule->second.high) << key;
        }
      }
    }
  }
  EXPECT_EQ(models, rules().at("model").words) << "each model is shown";
}

// Viewers that do not know the extras show the metal of the same colour, or the dielectric of the same index.
TEST(MaterialScenes, GltfValuesComeNextToTheModels) {
  int metals = 0, dielectrics = 0;
  for (const char* scene : kMaterialScenes) {
    const Glb glb(scene);
    for (const json& m : glb.root.at("materials")) {
      const json model = modelOf(m);
      if (model.is_null() || !model.contains("eta")) continue;
      SCOPED_TRACE(std::string(scene) + " " + m.at("name").get<std::string>());
      const json& pbr = m.at("pbrMetallicRoughness");
      const bool metal = !model.contains("kd");
      EXPECT_EQ(pbr.at("metallicFactor"), metal ? 1 : 0);
      for (std::size_t c = 0; c < 3; ++c) {
        const double eta = channel(model.at("eta"), c);
        if (metal) {
          EXPECT_NEAR(pbr.at("baseColorFactor").at(c).get<double>(),
                      normalReflectance(eta, channel(model.at("k"), c)), 1e-6);
          ++metals;
          continue;
        }
        const json extensions = m.value("extensions", json::object());
        const double ior = extensions.contains("KHR_materials_ior")
                               ? extensions.at("KHR_materials_ior").at("ior").get<double>()
                               : 1.5;
        // The index follows from the rounded root of the reflectance, whose error 1 - root magnifies.
        EXPECT_NEAR(ior, eta, eta * eta * 1e-6);
        EXPECT_EQ(pbr.at("baseColorFactor").at(c), model.at("kd").at(c));
        ++dielectrics;
      }
      // GGX's alpha is roughness^2, and that of a lobe with two widths is their geometric mean.
      const double width =
          !model.contains("roughness")
              ? 0
              : std::sqrt(channel(model.at("roughness"), 0) * channel(model.at("roughness"), 1));
      EXPECT_EQ(width == 0, model.at("model") == "coated");
      EXPECT_NEAR(std::pow(pbr.at("roughnessFactor").get<double>(), 2), width, 1e-6);
    }
  }
  EXPECT_GT(metals, 0);
  EXPECT_GT(dielectrics, 0);
}

TEST(MaterialScenes, AnisotropicMaterialsHaveTangents) {
  int checked = 0;
  for (const char* scene : kMaterialScenes) {
    const Glb glb(scene);
    for (const json& mesh : glb.root.at("meshes")) {
      SCOPED_TRACE(std::string(scene) + " " + mesh.at("name").get<std::string>());
      for (const json& p : mesh.at("primitives")) {
        const json model = modelOf(glb.root.at("materials").at(p.at("material").get<std::size_t>()));
        if (model.is_null()) continue;
        const json roughness = model.value("roughness", json(0.3));
        if (model.at("model") != "banks" && channel(roughness, 0) == channel(roughness, 1)) continue;
        ASSERT_TRUE(p.at("attributes").contains("TANGENT"));
        const auto normals = glb.read<Vec3>(p.at("attributes").at("NORMAL"));
        const auto tangents = glb.read<Vec4>(p.at("attributes").at("TANGENT"));
        ASSERT_EQ(normals.size(), tangents.size());
        double most = 0;
        for (std::size_t v = 0; v < normals.size(); ++v)
          most = std::max(most, std::abs(dot(normals[v], tangents[v])));
        EXPECT_LT(most, 1e-6) << "tangents are not perpendicular to normals";
        ++checked;
      }
    }
  }
  EXPECT_EQ(checked, 5) << "two discs, two spheres and the ball of silk";
}

/// The least or the largest |cosine| between tangent and radius where the mesh is level, off its axis.
double alongRadius(const Glb& glb, const std::string& mesh, bool least) {
  const json attributes = primitive(glb, mesh).at("attributes");
  const auto positions = glb.read<Vec3>(attributes.at("POSITION"));
  const auto normals = glb.read<Vec3>(attributes.at("NORMAL"));
  const auto tangents = glb.read<Vec4>(attributes.at("TANGENT"));
  std::optional<double> result;
  for (std::size_t v = 0; v < positions.size(); ++v) {
    const Vec3 out{positions[v][0], 0, positions[v][2]};
    const double radius = std::hypot(out[0], out[2]);
    if (radius < 1e-3 || std::abs(normals[v][1]) < 0.999) continue;
    const double cosine = std::abs(dot(out, tangents[v])) / radius;
    result = !result ? cosine : least ? std::min(*result, cosine) : std::max(*result, cosine);
  }
  EXPECT_TRUE(result) << mesh;
  return result.value_or(-1);
}

TEST(MaterialScenes, DiscsAreBrushedAlongCirclesAndAlongRadii) {
  const Glb glb("disk_and_sphere");
  EXPECT_LT(alongRadius(glb, "circular_disk", false), 1e-6);
  EXPECT_GT(alongRadius(glb, "radial_disk", true), 1 - 1e-6);
  EXPECT_FALSE(primitive(glb, "isotropic_disk").at("attributes").contains("TANGENT"));
}

TEST(MaterialScenes, SettingsAreThoseOfTheSource) {
  const Glb tori("torus_metal");
  for (const auto& [name, roughness] : {std::pair{"copper", 0.1}, {"aluminium", 0.05}}) {
    const auto indices = primitive(tori, name).at("indices").get<std::size_t>();
    EXPECT_EQ(tori.root.at("accessors").at(indices).at("count"), 3 * 2 * 200 * 200);
    EXPECT_NEAR(modelOf(material(tori, name)).at("roughness").get<double>(), roughness, 1e-8);
  }
  const Glb spheres("fresnel_spheres");
  for (const std::string& model :
       {std::string("torrance_sparrow"), std::string("phong"), std::string("coated")}) {
    for (const auto& [name, eta] : {std::pair{"1.5", 1.5}, {"5", 5.}, {"200", 200.}}) {
      const json what = modelOf(material(spheres, model + "_" + name));
      EXPECT_EQ(what.at("model"), model);
      if (model == "phong")
        EXPECT_NEAR(what.at("ks").get<double>(), normalReflectance(eta, 0), 1e-6);
      else
        EXPECT_EQ(what.at("eta"), eta);
    }
  }
  EXPECT_EQ(modelOf(material(Glb("glossy_torus"), "lacquer")).at("exponent"), 100);
}

}  // namespace
}  // namespace limn::test
