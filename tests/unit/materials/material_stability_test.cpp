// The material models at the ends of their parameters and where directions degenerate.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/unit/materials/models.h"

namespace limn::glsl {
namespace {

bool sound(const vec3& value) {
  for (int c = 0; c < 3; ++c)
    if (!(std::isfinite(value[c]) && value[c] >= 0 && std::isfinite(value[c] * 1e5f)))
      return false;  // a sun of 1e5
  return true;
}

/// All models, and the extremes of each parameter.
std::vector<NamedModel> extremes() {
  std::vector<NamedModel> all = allModels();
  for (uint kind = model_none; kind <= model_coated; ++kind)
    for (const float roughness : {0.f, 1.f, 2.f})
      for (const float eta : {1e-3f, 1.f, 1.0001f, 200.f, 1000.f})
        for (const float k : {0.f, 1000.f})
          for (const float albedo : {0.f, 1.f})
            for (const float exponent : {0.f, 1e6f})
              for (const uint options : {0u, 31u}) {
                MaterialModel m{};
                m.kind = kind;
                m.eta = vec3(eta, 1, 1.5f);
                m.k = vec3(k, 0, 1);
                m.kd = vec3(albedo);
                m.ks = vec3(1 - albedo, 1, 0);
                m.exponent = exponent;
                m.roughness = vec2(roughness, 0.5f);
                m.options = options;
                all.push_back({"extreme of " + std::to_string(kind), m});
              }
  return all;
}

std::vector<vec3> directions() {
  std::vector<vec3> all;
  for (const float z : {-1.f, -0.5f, -1e-7f, 0.f, 1e-38f, 1e-20f, 1e-7f, 1e-4f, 0.5f, 1.f})
    for (const float azimuth : {0.f, 3.14159265f, 1.f, 1.57079633f}) {
      const float sine = std::sqrt(1 - z * z);
      all.emplace_back(sine * std::cos(azimuth), sine * std::sin(azimuth), z);
    }
  return all;
}

TEST(MaterialStability, ResponsesAndDensitiesAreFinite) {
  for (const NamedModel& named : extremes()) {
    const MaterialModel& m = named.model;
    const auto check = [&](const vec3& v, const vec3& l) {
      const vec3 response = model_response(m, v, l);
      const float pdf = model_pdf(m, v, l);
      ASSERT_TRUE(sound(response)) << named.name << ' ' << v.z << ' ' << l.z << ' ' << response.x;
      ASSERT_TRUE(std::isfinite(pdf) && pdf >= 0) << named.name << ' ' << v.z << ' ' << l.z << ' ' << pdf;
      if (!(l.z > 0)) {
        ASSERT_EQ(response, vec3(0));
        ASSERT_EQ(pdf, 0);
      }
      if (response != vec3(0)) {
        ASSERT_GT(pdf, 0) << named.name << ' ' << v.z << ' ' << l.z << ' ' << response.x;
      }
    };
    for (const vec3& v : directions()) {
      for (const vec3& l : directions()) check(v, l);
      check(v, -v);
      check(v, v);
      check(v, vec3(-v.x, -v.y, v.z));  // h = n
    }
  }
}

TEST(MaterialStability, SamplesAreDirections) {
  for (const NamedModel& named : extremes())
    for (const vec3& v : directions())
      for (const float x : {0.f, 0.5f, 0.99999994f})
        for (const float y : {0.f, 0.5f, 0.99999994f})
          for (const float z : {0.f, 0.6f, 0.99999994f}) {
            const vec3 l = model_sample(named.model, v, {x, y, z});
            ASSERT_NEAR(length(l), 1, 1e-5f) << named.name << ' ' << v.z << ' ' << x << ' ' << y << ' ' << z;
          }
}

TEST(MaterialStability, AlbedosAreAlbedos) {
  for (const NamedModel& named : extremes()) {
    const vec3 albedo = model_albedo(named.model);
    EXPECT_TRUE(sound(albedo) && largest_channel(albedo) <= 1) << named.name;
    EXPECT_TRUE(std::isfinite(model_excess(named.model))) << named.name;
  }
}

TEST(MaterialStability, NoModelReflectsNothing) {
  MaterialModel m = whiteModel(model_none);
  m.kd = vec3(1);
  EXPECT_EQ(model_response(m, vec3(0, 0, 1), vec3(0, 0, 1)), vec3(0));
  EXPECT_EQ(sizeof(MaterialModel), 80u);
}

TEST(MaterialStability, RoughnessIsClamped) {
  const vec3 v = directionAt(0.6, 0.3), l = directionAt(0.6, 0.3 + M_PI);
  for (const uint kind : {model_torrance_sparrow, model_ward})
    EXPECT_EQ(model_response(microfacets(kind, vec2(0)), v, l),
              model_response(microfacets(kind, vec2(1e-3f)), v, l));
}

TEST(MaterialStability, OnlyWardAndBanksAreAnisotropic) {
  EXPECT_FALSE(model_anisotropic(microfacets(model_ward, vec2(0.2f))));
  EXPECT_TRUE(model_anisotropic(microfacets(model_ward, vec2(0.2f, 0.3f))));
  EXPECT_TRUE(model_anisotropic(banksModel(0.1f, 0.1f, 10)));
  EXPECT_FALSE(model_anisotropic(microfacets(model_torrance_sparrow, vec2(0.2f, 0.3f))));
  EXPECT_FALSE(model_anisotropic(phongModel(0.5f, 0.5f, 10)));
}

}  // namespace
}  // namespace limn::glsl
