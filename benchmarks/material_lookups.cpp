// What a material costs by its formula and by tables: a pass that does nothing but reflect four lights on a
// sphere of copper that fills the picture, in milliseconds above the same pass without a material, and over
// the formula. All are timed in turns. Arguments: turns (15), frames of each turn (3).
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/bench/ratio.h"
#include "core/brdf/factor_fit.h"
#include "core/brdf/model_brdf.h"
#include "core/context/context.h"
#include "core/frame/frame_graph.h"
#include "core/render/frame_stats.h"
#include "glsl/materials/material_model.glsl"

namespace {

using namespace limn;
using brdf::Factorisation;

constexpr int kWidth = 1024, kHeight = 768;
constexpr glm::vec4 kLights[] = {
    {0, 0, 1, 0}, {0.60f, 0.50f, 0.62f, 0}, {-0.79f, 0.30f, 0.53f, 0}, {0.20f, -0.90f, 0.39f, 0}};

constexpr gpu::EmbeddedSource kSources[] = {{"reflect.comp.glsl", R"(
#define MATERIAL_MODELS 2
#include "glsl/materials/factored.glsl"
#include "glsl/materials/model.glsl"
#include "glsl/surface/brdf.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(std430) readonly buffer MaterialModels { MaterialModel material_models[]; };
layout(std430) readonly buffer Lights { vec4 lights[]; };
#if TABLES > 0
uniform sampler2DArray factored_1;
#endif
#if TABLES > 1
uniform sampler2DArray factored_2;
#endif
layout(rgba16f) writeonly uniform image2D target;

vec3 reflected(MaterialModel m, vec3 v, vec3 l) { return PRODUCT; }

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  vec2 place = 0.7 * (2.0 * (vec2(pixel) + 0.5) / vec2(imageSize(target)) - 1.0);
  Frame frame = frame_around(vec3(place, sqrt(1.0 - dot(place, place))));
  vec3 v = to_local(frame, vec3(0.0, 0.0, 1.0));
  MaterialModel m = material_models[pixel.x & 1];
  vec3 sum = vec3(0.0);
  for (int i = 0; i < 4; ++i) {
    vec3 l = to_local(frame, lights[i].xyz);
    if (l.z > 0.0) sum += reflected(m, v, l);
  }
  imageStore(target, pixel, vec4(sum, 1.0));
}
)"}};

/// Copper whose slopes have Beckmann's distribution, of the width that most metals have.
glsl::MaterialModel copper() {
  glsl::MaterialModel model{};
  model.kind = glsl::model_torrance_sparrow;
  model.eta = {0.27f, 0.68f, 1.32f};
  model.k = {3.61f, 2.63f, 2.29f};
  model.ks = glm::vec3(1);
  model.roughness = glm::vec2(0.3f);
  return model;
}

/// Is a way to reflect light: the expression, and the tables that it looks up.
struct Way {
  std::string name, product;
  brdf::FactoredBrdf fit;
};

std::vector<Way> ways() {
  const glsl::MaterialModel model = copper();
  const brdf::Brdf f = brdf::modelBrdf(model, {});
  const auto fitted = [&](Factorisation factorisation, int texels, int terms = 1) {
    return brdf::fitBrdf(f,
                         {.factorisation = factorisation, .texels = texels, .terms = terms, .samples = 8000});
  };
  const brdf::TorranceSparrow exact{.eta = glm::dvec3(model.eta), .k = glm::dvec3(model.k), .roughness = 0.3};
  const std::string angles = "factored_angles(vec3(0.0, 0.0, 1.0), v, l)";
  std::vector<Way> result;
  result.push_back({"no material", "m.ks * l.z * v.z", {}});
  result.push_back({"Beckmann, conductor (the formula)", "model_response(m, v, l)", {}});
  result.push_back(
      {"GGX, Schlick (glTF)",
       "brdf(surface_brdf(m.ks, 1.0, m.roughness.x, 1.0, vec3(1.0), 1.5), vec3(0.0, 0.0, 1.0), v, l) * l.z",
       {}});
  result.push_back({"two tables, 128 x 128",
                    "factored_response(factored_1, factored_2, 0, " + angles + ", true)",
                    brdf::torranceSparrowTables(exact, 128, 128, true, brdf::TableFormat::half)});
  result.push_back(
      {"dfg", "factored_dfg_response(factored_1, 0, 1, " + angles + ")", fitted(Factorisation::dfg, 64)});
  result.push_back(
      {"pqp", "factored_pqp_response(factored_1, 0, 1, " + angles + ")", fitted(Factorisation::pqp, 64)});
  result.push_back({"pqp_disc", "factored_pqp_disc_response(factored_1, 0, 1, v, l, true)",
                    fitted(Factorisation::pqp_disc, 32)});
  result.push_back({"dfg_disc", "factored_dfg_disc_response(factored_1, factored_2, 0, 1, v, l, true)",
                    fitted(Factorisation::dfg_disc, 32)});
  for (const int terms : {1, 4})
    result.push_back({fmt::format("svd, terms={}", terms),
                      fmt::format("factored_svd_response(factored_1, factored_2, 0, {}, v, l)", terms),
                      fitted(Factorisation::svd, 24, terms)});
  Way volume{"trilinear", "", fitted(Factorisation::trilinear, 32)};
  volume.product =
      fmt::format("factored_volume_response(factored_1, 0, {}, v, l)", volume.fit.tables[0].depth);
  result.push_back(std::move(volume));
  return result;
}

gpu::Texture uploaded(gpu::Device& device, const brdf::FactorTable& table) {
  gpu::Texture texture(device, "factors",
                       {.target = GL_TEXTURE_2D_ARRAY,
                        .format = GL_RGBA16F,
                        .width = table.width,
                        .height = table.height,
                        .layers = table.depth});
  texture.setSampling(GL_LINEAR, GL_LINEAR);
  for (int z = 0; z < table.depth; ++z) texture.upload(0, z, GL_RGB, GL_FLOAT, &table.at(0, 0, z));
  return texture;
}

/// Is the pass of one way, and what it took.
class Pass {
  std::vector<gpu::Texture> tables_;
  frame::FrameGraph graph_;

 public:
  std::vector<double> milliseconds;

  Pass(const Way& way, gpu::Device& device, gpu::ShaderLibrary& shaders, frame::ResourcePool& pool,
       const gpu::Buffer& models, const gpu::Buffer& lights) {
    using frame::Access;
    for (const brdf::FactorTable& table : way.fit.tables) tables_.push_back(uploaded(device, table));
    frame::PassBuilder pass = graph_.addPass("reflect");
    pass.read(graph_.importBuffer("models", models), Access::storageLoad, "MaterialModels", "materials")
        .read(graph_.importBuffer("lights", lights), Access::storageLoad, "Lights", "directions");
    constexpr const char* kSamplers[] = {"factored_1", "factored_2"};
    for (size_t i = 0; i < tables_.size(); ++i)
      pass.read(graph_.importTexture(kSamplers[i], tables_[i]), Access::sampled, kSamplers[i], "factors");
    const frame::TextureHandle target =
        pass.write(graph_.createTexture("target", {.format = GL_RGBA16F, .width = kWidth, .height = kHeight}),
                   Access::imageStore, "target", "reflected light");
    const frame::ProgramHandle program =
        pass.program({{"techniques/benchmark/reflect.comp.glsl"},
                      {{"PRODUCT", way.product}, {"TABLES", fmt::format("{}", tables_.size())}}});
    pass.execute([program](frame::PassContext& context) {
      context.use(program);
      context.dispatch(kWidth, kHeight, 1, 8, 8);
    });
    graph_.output(target);
    graph_.prepare(device, shaders, pool);
  }

  void draw(const gl::Functions& gl) {
    graph_.execute();
    gl.Finish();
  }
  void time(const gl::Functions& gl) {
    const auto begin = std::chrono::steady_clock::now();
    draw(gl);
    const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - begin;
    milliseconds.push_back(taken.count());
  }
};

double median(const std::vector<double>& values) {
  return render::quartiles(values).median;
}

/// Returns what a pass took above the pass without a material, of the median of its turn.
std::vector<double> above(const Pass& pass, const Pass& nothing, int frames) {
  std::vector<double> result;
  for (size_t i = 0; i < pass.milliseconds.size(); ++i) {
    const auto turn = nothing.milliseconds.begin() + static_cast<std::ptrdiff_t>(i) / frames * frames;
    result.push_back(std::max(pass.milliseconds[i] - median({turn, turn + frames}), 1e-3));
  }
  return result;
}

void measure(int turns, int frames) {
  const auto context = Context::create({});
  gpu::Device device(*context);
  gpu::ShaderLibrary shaders(device);
  shaders.mount("", embeddedSources());
  shaders.mount("techniques/benchmark/", kSources);
  frame::ResourcePool pool(device);
  const glsl::MaterialModel both[] = {copper(), copper()};
  const gpu::Buffer models = gpu::Buffer::of<glsl::MaterialModel>(device, "models", both);
  const gpu::Buffer lights = gpu::Buffer::of<glm::vec4>(device, "lights", kLights);
  const std::vector<Way> all = ways();
  std::vector<std::unique_ptr<Pass>> passes;
  for (const Way& way : all) {
    passes.push_back(std::make_unique<Pass>(way, device, shaders, pool, models, lights));
    passes.back()->draw(context->gl());
  }
  for (int turn = 0; turn < turns; ++turn)
    for (const auto& pass : passes)
      for (int i = 0; i < frames; ++i) pass->time(context->gl());

  fmt::print("{}, {} x {}, 4 lights, {} turns of {} frames; without a material {:.2f} ms\n\n",
             context->info().renderer, kWidth, kHeight, turns, frames, median(passes[0]->milliseconds));
  fmt::print("| material | ms | over the formula |\n| --- | --: | --: |\n");
  const std::vector<double> formula = above(*passes[1], *passes[0], frames);
  for (size_t i = 1; i < passes.size(); ++i) {
    const std::vector<double> taken = above(*passes[i], *passes[0], frames);
    const bench::Ratio ratio = bench::ratioOfMedians({taken, turns}, {formula, turns});
    fmt::print("| {} | {:.2f} | {:.2f} ({:.2f} to {:.2f}) |\n", all[i].name, median(taken), ratio.value,
               ratio.low, ratio.high);
  }
}

}  // namespace

int main(int count, char** arguments) {
  const int turns = count > 1 ? std::atoi(arguments[1]) : 15;
  const int frames = count > 2 ? std::atoi(arguments[2]) : 3;
  if (turns < 2 || frames < 1) {
    fmt::print(stderr, "limn-benchmark-material-lookups: at least 2 turns of 1 frame\n");
    return 2;
  }
  try {
    measure(turns, frames);
  } catch (const std::exception& error) {
    fmt::print(stderr, "limn-benchmark-material-lookups: {}\n", error.what());
    return 1;
  }
  return 0;
}
