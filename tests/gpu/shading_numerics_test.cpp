// The shading headers give the same numbers as GLSL and as C++, and keep their precision where GLSL promises
// none of its functions: asin and log where they are small, % of negative numbers. Worst relative differences
// measured on llvmpipe: BRDF 8e-7, sampled directions 1.3e-5, rectangle 2e-6, sampled points 3e-6, table
// 2e-7; unshadowed light 1.7e-4 of 0.01 or its value (a lobe of width alpha multiplies the rounding of
// directions by 1 / alpha).
#include "tests/gpu/shading_numerics.glsl"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "core/base/file.h"
#include "core/shading/ltc_table.h"
#include "glsl/rays/ray_coverage.glsl"
#include "tests/gpu/bind_by_name.h"
#include "tests/gpu/gl_test.h"
#include "tests/support/closed_forms.h"
#include "tests/support/paths.h"

namespace limn {
namespace {

using glm::vec3;
using glm::vec4;

constexpr const char* kValues = R"(
#include "glsl/caustics/caustic_line.glsl"
#include "glsl/indirect/virtual_area_light.glsl"
#include "glsl/light/light_part.glsl"
#include "glsl/materials/fresnel.glsl"
#include "glsl/rays/ray_coverage.glsl"
layout(local_size_x = 64) in;
layout(std430) readonly buffer Arguments { vec4 arguments[]; };
layout(std430) writeonly buffer Values { float values[]; };

float diameter_of_part(float diameter, float count) {
  Light light;
  light.type = light_directional;
  light.position = vec3(0.0);
  light.direction = vec3(0.0, -1.0, 0.0);
  light.axis_u = vec3(0.0);
  light.axis_v = vec3(0.0);
  light.length_u = 0.0;
  light.length_v = 0.0;
  light.angular_diameter = diameter;
  light.flags = 0u;
  return light_part(light, light_kind_disc, -1.0, uvec2(count), 0u).angular_diameter;
}

// Of a disc whose middle lies that many of its radii above the tangent plane.
float share_of_disc(float height) {
  LightView v;
  v.whole = false;
  v.masked = false;
  v.cone = true;
  v.cap = 0.01;
  v.normal = vec3(0.0, 0.0, 1.0);
  v.centre = vec3(0.0, 0.0, height * sqrt(v.cap * (2.0 - v.cap)));
  return light_view_share(v);
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= uint(arguments.length())) return;
  vec4 x = arguments[i];
  values[i] = VALUE;
}
)";

class ShadingNumerics : public GlTest {
 protected:
  /// Returns a GLSL expression of a vector x for each of the arguments, as the GPU computes it.
  std::vector<float> valuesOf(const std::string& expression, const std::vector<vec4>& arguments) {
    const std::array<gpu::EmbeddedSource, 1> sources{{{"values.comp.glsl", kValues}}};
    shaders().mount("test/", sources);
    const gpu::Buffer in = gpu::Buffer::of<vec4>(device(), "arguments", arguments);
    const gpu::Buffer out(device(), "values", arguments.size() * sizeof(float));
    gpu::Program& program =
        shaders().program({.files = {"test/values.comp.glsl"}, .defines = {{"VALUE", expression}}});
    program.use();
    test::bindByName(gl(), program, "Arguments", in);
    test::bindByName(gl(), program, "Values", out);
    gl().DispatchCompute(static_cast<GLuint>((arguments.size() + 63) / 64), 1, 1);
    gl().MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    std::vector<float> values(arguments.size());
    out.read(0, values.data(), values.size() * sizeof(float));
    return values;
  }
};

vec3 upward(std::mt19937& random, float lowest) {
  std::uniform_real_distribution<float> unit(0.f, 1.f);
  const float z = lowest + (1 - lowest) * unit(random), angle = 6.2831853f * unit(random);
  const float sine = std::sqrt(1 - z * z);
  return {sine * std::cos(angle), sine * std::sin(angle), z};
}

glsl::NumericsInput randomInput(std::mt19937& random) {
  std::uniform_real_distribution<float> unit(0.f, 1.f);
  glsl::NumericsInput i{};
  i.base_colour = vec3(unit(random), unit(random), unit(random));
  i.metallic = unit(random) < 0.5f ? 0.f : unit(random);
  i.roughness = 0.1f + 0.9f * unit(random);
  i.specular_factor = unit(random) < 0.2f ? 0.f : unit(random);
  i.ior = 1 + unit(random);
  i.random = vec3(unit(random), unit(random), unit(random));
  i.normal = vec4(upward(random, 0.9f), 0);
  i.view = vec4(upward(random, 0.5f), 0);
  i.incident = vec4(upward(random, 0.05f), 0);
  const vec3 towards = upward(random, -0.3f) * std::pow(10.f, 3 * unit(random) - 0.5f);
  i.light.position = towards;
  const glsl::Frame frame =
      glsl::frame_around(normalize(towards + 0.7f * glm::length(towards) * upward(random, -1)));
  i.light.direction = -frame.n;
  i.light.axis_u = frame.t;
  i.light.length_u = unit(random) + 0.1f;
  i.light.axis_v = frame.b;
  i.light.length_v = unit(random) + 0.1f;
  i.light.emission = vec3(1, 2, 3);
  i.light.type = glsl::light_rectangle;
  i.light.flags = glsl::light_flag_two_sided;
  i.light.own_instance = glsl::no_instance;
  return i;
}

std::string source(const char* name) {
  return readTextFile(std::string(test::kSourceDir) + "/tests/gpu/" + name);
}

TEST_F(ShadingNumerics, GpuAgreesWithCpu) {
  std::mt19937 random(1);
  std::vector<glsl::NumericsInput> inputs(20000);
  for (auto& input : inputs) input = randomInput(random);

  const std::string header = source("shading_numerics.glsl"), entry = source("shading_numerics.comp.glsl");
  const std::array<gpu::EmbeddedSource, 2> sources{
      {{"shading_numerics.glsl", header.c_str()}, {"shading_numerics.comp.glsl", entry.c_str()}}};
  shaders().mount("test/", sources);
  const gpu::Texture table = shading::makeLtcTexture(device());
  const gpu::Buffer in = gpu::Buffer::of<glsl::NumericsInput>(device(), "inputs", inputs);
  const gpu::Buffer out(device(), "results", inputs.size() * sizeof(glsl::NumericsResult));
  gpu::Program& program = shaders().program({.files = {"test/shading_numerics.comp.glsl"}, .defines = {}});
  program.use();
  test::bindByName(gl(), program, "ltc_table", table);
  test::bindByName(gl(), program, "Inputs", in);
  test::bindByName(gl(), program, "Results", out);
  gl().DispatchCompute(static_cast<GLuint>((inputs.size() + 63) / 64), 1, 1);
  gl().MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  std::vector<glsl::NumericsResult> results(inputs.size());
  out.read(0, results.data(), results.size() * sizeof(results[0]));

  // Differences relative to the vector's length, or to the natural unit of the quantity where that is larger.
  struct Quantity {
    const char* name;
    vec4 glsl::NumericsResult::*member;
    float unit;
    double bound;
    double worst = 0;
  };
  std::vector<Quantity> quantities{{"brdf", &glsl::NumericsResult::reflected, 0.1f, 1e-5},
                                   {"sampled direction", &glsl::NumericsResult::direction, 1, 1e-4},
                                   {"rectangle", &glsl::NumericsResult::rectangle, 1e-6f, 1e-5},
                                   {"sampled point", &glsl::NumericsResult::point, 1, 1e-5},
                                   {"unshadowed light", &glsl::NumericsResult::unshadowed, 0.01f, 1e-3},
                                   {"ltc shape", &glsl::NumericsResult::shape, 1, 1e-5},
                                   {"ltc reflectance", &glsl::NumericsResult::reflectance, 1, 1e-5},
                                   {"g-buffer", &glsl::NumericsResult::colour, 1, 1e-5}};
  for (size_t i = 0; i < inputs.size(); ++i) {
    const glsl::NumericsResult expected = glsl::numerics(inputs[i]);
    for (Quantity& q : quantities) {
      const vec4 there = results[i].*q.member, here = expected.*q.member;
      const double error = glm::length(there - here) / std::max(q.unit, glm::length(here));
      q.worst = std::max(q.worst, std::isnan(error) ? 1e30 : error);
    }
  }
  for (const Quantity& q : quantities) {
    EXPECT_LT(q.worst, q.bound) << q.name;
    RecordProperty(q.name, std::to_string(q.worst));
  }
}

/// A line across the view, whose ends lie to both sides of its middle: its light is the angle between them.
TEST_F(ShadingNumerics, ShortLightLinesHaveTheAngleTheySpan) {
  std::vector<vec4> sides;
  for (float side = 2e-5f; side < 1; side *= 1.2f) sides.emplace_back(side, 0, 0, 0);
  const std::vector<float> weights =
      valuesOf("caustic_point_weight(vec3(-x.x, 0.0, 1.0), vec3(x.x, 0.0, 1.0), 1.0)", sides);
  for (size_t i = 0; i < sides.size(); ++i)
    EXPECT_NEAR(static_cast<double>(weights[i]) / (2 * std::atan(static_cast<double>(sides[i].x))), 1, 5e-6)
        << sides[i].x;
}

/// Relative error of atan: 2.1e-5 of its value with llvmpipe, at any size of the angle.
constexpr double kArcTangent = 3e-5;

/// GPUs' sines of small angles are off by 5e-7, and four of them by 2e-6.
TEST_F(ShadingNumerics, PartsOfDiscsHaveTheirDiameter) {
  std::vector<vec4> discs;
  for (const float diameter : {0.0093f, 0.1f, 0.4f, 1.f, 2.f})
    for (const float count : {2.f, 3.f, 5.f}) discs.emplace_back(diameter, count, 0, 0);
  const std::vector<float> diameters = valuesOf("diameter_of_part(x.x, x.y)", discs);
  for (size_t i = 0; i < discs.size(); ++i) {
    const double whole = static_cast<double>(discs[i].x), count = static_cast<double>(discs[i].y);
    const double exact = 4 * std::asin(std::sin(whole / 4) / count);
    EXPECT_NEAR(diameters[i], exact, kArcTangent * exact + 2e-6) << whole << " in " << count;
  }
}

TEST_F(ShadingNumerics, DiscsBehindTheHorizonHaveTheirShare) {
  std::vector<vec4> heights;
  for (int i = -50; i <= 50; ++i) heights.emplace_back(static_cast<float>(i) / 50, 0, 0, 0);
  const std::vector<float> shares = valuesOf("share_of_disc(x.x)", heights);
  for (size_t i = 0; i < heights.size(); ++i) {
    const double h = static_cast<double>(heights[i].x);
    EXPECT_NEAR(shares[i], 1 - (std::acos(h) - h * std::sqrt(1 - h * h)) / M_PI, 2e-6) << h;
  }
}

TEST_F(ShadingNumerics, SmallAnglesBetweenNormalsKeepTheirDigits) {
  std::vector<vec4> normals;
  for (float angle = 1e-4f; angle < 2; angle *= 1.2f)
    normals.emplace_back(std::sin(angle), 0, std::cos(angle), 0);
  const std::vector<float> angles = valuesOf("cluster_angle(x.xyz, vec3(0.0, 0.0, 1.0))", normals);
  for (size_t i = 0; i < normals.size(); ++i) {
    const double chord = glm::length(glm::dvec3(normals[i]) - glm::dvec3(0, 0, 1));
    EXPECT_NEAR(static_cast<double>(angles[i]) / (2 * std::asin(0.5 * chord) / M_PI), 1, kArcTangent)
        << chord;
  }
}

/// On the processor within 1e-5. Above 1.04 terms of up to 14 cancel, whose divisions GLSL allows 2.5 units
/// in the last place: 1.2e-5 more.
TEST_F(ShadingNumerics, MeanReflectanceNextToOneIsTheQuadratures) {
  std::vector<vec4> indices;
  for (const float eta :
       {1.f, 1.0001f, 1.005f, 1.019f, 1.021f, 1.1f, 1.33f, 1.5f, 1.51f, 2.4f, 5.f, 200.f, 1000.f})
    indices.emplace_back(eta, 0, 0, 0);
  for (int i = 0; i < 64; ++i) indices.emplace_back(1.035f + 0.001f * static_cast<float>(i), 0, 0, 0);
  const std::vector<float> means = valuesOf("dielectric_mean_reflectance(x.x)", indices);
  for (size_t i = 0; i < indices.size(); ++i) {
    constexpr int n = 20000;
    double exact = 0;  // over cos = t^2
    for (int k = 0; k < n; ++k) {
      const double t = (k + 0.5) / n;
      exact += test::fresnel(t * t, 1, static_cast<double>(indices[i].x)) * 4 * t * t * t / n;
    }
    EXPECT_NEAR(means[i], exact, 2.2e-5) << indices[i].x;
  }
}

/// As on the processor (tests/unit/rays/coverage_test.cpp), from a whole texture before the first texel.
TEST_F(ShadingNumerics, TexturesGoOnBeforeTheirFirstTexel) {
  std::vector<vec4> places;
  for (const uint32_t wrap : {glsl::ray_wrap_repeat, glsl::ray_wrap_clamp, glsl::ray_wrap_mirror})
    for (const int size : {1, 3, 4})
      for (int i = -size; i <= 2 * size; ++i) places.emplace_back(i, size, wrap, 0);
  const std::vector<float> texels = valuesOf("float(ray_wrap(int(x.x), int(x.y), uint(x.z)))", places);
  for (size_t i = 0; i < places.size(); ++i) {
    const int at = static_cast<int>(places[i].x), size = static_cast<int>(places[i].y);
    const auto wrap = static_cast<uint32_t>(places[i].z);
    EXPECT_EQ(static_cast<int>(texels[i]), glsl::ray_wrap(at, size, wrap))
        << at << " of " << size << ", " << wrap;
  }
}

}  // namespace
}  // namespace limn
