// The shading headers give the same numbers as GLSL and as C++. Worst relative differences measured on
// llvmpipe: BRDF 8e-7, sampled directions 1.3e-5, rectangle 2e-6, sampled points 3e-6, table 2e-7; unshadowed
// light 1.7e-4 of 0.01 or its value (a lobe of width alpha multiplies the rounding of directions by 1 /
// alpha).
#include "tests/gpu/shading_numerics.glsl"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "core/base/file.h"
#include "core/shading/ltc_table.h"
#include "tests/gpu/bind_by_name.h"
#include "tests/gpu/gl_test.h"
#include "tests/support/paths.h"

namespace limn {
namespace {

using glm::vec3;
using glm::vec4;

class ShadingNumerics : public GlTest {};

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

}  // namespace
}  // namespace limn
