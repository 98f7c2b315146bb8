// Environment light and tone mapping in GLSL against the same in C++.
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "core/shading/environment.h"
#include "core/shading/ltc_table.h"
#include "glsl/light/environment.glsl"
#include "glsl/numeric/srgb.glsl"
#include "tests/gpu/bind_by_name.h"
#include "tests/gpu/gl_test.h"

namespace limn {
namespace {

using glm::vec3;
using glm::vec4;

constexpr float kRotation = 0.7f, kScale = 1.5f;

constexpr const char* kShader = R"(
#include "glsl/light/environment.glsl"
layout(local_size_x = 64) in;
struct Point { vec4 base; vec4 surface; vec4 normal; vec4 view; };
layout(std430) readonly buffer Points { Point points[]; };
layout(std430) writeonly buffer Results { vec4 results[]; };
uniform float rotation;
uniform float scale;
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= uint(points.length())) return;
  Point p = points[i];
  SurfaceBrdf s = surface_brdf(p.base.rgb, p.base.w, p.surface.x, p.surface.y, vec3(1.0), p.surface.z);
  vec3 n = p.normal.xyz;
  results[i] = vec4(reflected_whole(environment_light(s, n, n, p.view.xyz, rotation, scale)), 1.0);
}
)";

struct Point {
  vec4 base, surface, normal, view;
};

vec3 expected(const shading::FilteredEnvironment& environment, const Point& p) {
  const glsl::SurfaceBrdf s =
      glsl::surface_brdf(vec3(p.base), p.base.w, p.surface.x, p.surface.y, vec3(1), p.surface.z);
  const vec3 n(p.normal), v(p.view);
  const glsl::LtcTerms terms = glsl::ltc_lookup(dot(n, v), s.alpha);
  const auto turned = [](vec3 d) { return glsl::environment_lookup_direction(d, kRotation); };
  return glsl::reflected_whole(glsl::environment_reflection(
      s, terms, kScale * environment.irradiance.sample(turned(n)),
      kScale *
          environment.filtered(turned(glsl::environment_lobe_direction(terms, n, v, s.alpha)), s.alpha)));
}

class EnvironmentLight : public GlTest {};

// The texture unit's fraction has 8 bits on most GPUs: 1/512 of the difference between neighbouring texels,
// and the filtered map is stored in halves.
TEST_F(EnvironmentLight, GpuAgreesWithCpu) {
  scene::Environment source;
  source.width = 128;
  source.height = 64;
  std::mt19937 random(1);
  std::uniform_real_distribution<float> unit(0.f, 1.f);
  for (int y = 0; y < source.height; ++y) {
    for (int x = 0; x < source.width; ++x) {
      source.texels.push_back(
          vec3(2 + std::sin(0.2f * static_cast<float>(x)), 1 + 0.02f * static_cast<float>(y), 1));
    }
  }
  const shading::FilteredEnvironment environment = shading::filterEnvironment(source);

  std::normal_distribution<float> normal;
  std::vector<Point> points(5000);
  for (Point& p : points) {
    const vec3 n = normalize(vec3(normal(random), normal(random), normal(random)));
    const vec3 v = normalize(vec3(normal(random), normal(random), normal(random)));
    p.normal = vec4(n, 0);
    p.view = vec4(dot(n, v) < 0 ? -v : v, 0);
    p.base = vec4(unit(random), unit(random), unit(random), unit(random));
    p.surface = vec4(unit(random), unit(random), 1 + unit(random), 0);
  }

  const std::array<gpu::EmbeddedSource, 1> sources{{{"environment.comp.glsl", kShader}}};
  shaders().mount("test/", sources);
  const gpu::Texture table = shading::makeLtcTexture(device());
  const gpu::Texture irradiance = shading::makeIrradianceTexture(device(), environment.irradiance);
  const gpu::Texture filtered = shading::makeFilteredTexture(device(), environment);
  const gpu::Buffer in = gpu::Buffer::of<Point>(device(), "points", points);
  const gpu::Buffer out(device(), "results", points.size() * sizeof(vec4));
  gpu::Program& program = shaders().program({.files = {"test/environment.comp.glsl"}, .defines = {}});
  program.use();
  program.set("rotation", kRotation);
  program.set("scale", kScale);
  test::bindByName(gl(), program, "ltc_table", table);
  test::bindByName(gl(), program, "environment_irradiance", irradiance);
  test::bindByName(gl(), program, "environment_filtered", filtered);
  test::bindByName(gl(), program, "Points", in);
  test::bindByName(gl(), program, "Results", out);
  gl().DispatchCompute(static_cast<GLuint>((points.size() + 63) / 64), 1, 1);
  gl().MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  std::vector<vec4> results(points.size());
  out.read(0, results.data(), results.size() * sizeof(vec4));

  double worst = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    const vec3 here = expected(environment, points[i]);
    worst =
        std::max(worst, static_cast<double>(length(vec3(results[i]) - here) / std::max(length(here), 0.1f)));
  }
  RecordProperty("worst", std::to_string(worst));
  EXPECT_LT(worst, 4e-3);
}

class ToneMap : public GlTest {};

TEST_F(ToneMap, WritesWhatTheFileWriterWrites) {
  const std::vector<vec4> radiance{
      {0, 0.001f, 0.18f, 1}, {1, 2, 1e6f, 1}, {-1, std::nanf(""), 0.5f, 1}, {0.25f, 0.5f, 0.75f, 1}};
  const float exposure = -0.5f;
  gpu::Texture in(device(), "radiance", {.format = GL_RGBA32F, .width = 4, .height = 1});
  in.upload(0, 0, GL_RGBA, GL_FLOAT, radiance.data());
  const gpu::Texture out(device(), "display", {.format = GL_RGBA8, .width = 4, .height = 1});
  gpu::Program& program =
      shaders().program({.files = {"glsl/deferred/tone_map.comp.glsl"}, .defines = {{"VISIBILITY", "0"}}});
  program.use();
  program.set("exposure_ev", exposure);
  test::bindByName(gl(), program, "radiance", in);
  test::bindByName(gl(), program, "display", out);
  gl().DispatchCompute(1, 1, 1);
  gl().MemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
  std::array<uint8_t, 16> pixels{};
  out.read(0, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data(), pixels.size());
  for (size_t i = 0; i < 4; ++i) {
    for (int c = 0; c < 3; ++c) {
      const float value = glsl::tone_map(radiance[i][c], exposure);
      EXPECT_NEAR(pixels[4 * i + static_cast<size_t>(c)], std::lround(255 * value), 1) << i << ' ' << c;
    }
  }
}

}  // namespace
}  // namespace limn
