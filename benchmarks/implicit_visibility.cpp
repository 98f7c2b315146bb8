// How the stages of implicit visibility grow with the number of surface elements, through the hierarchy and
// for every pair: a wavy body over a floor, 6 x 16 x 16 bins, all cores. Arguments: elements, 1 for the
// published way to fill bins. Table 4.1: the stages of the monster's links, by bins. And what bins get wrong:
// indirect light at the vertices against path tracing.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <map>
#include <numeric>
#include <string>

#include "core/radiosity/illumination.h"
#include "core/radiosity/scene_elements.h"
#include "core/reference/vertices.h"
#include "core/render/frame_stats.h"
#include "core/scene_io/load.h"
#include "tests/support/radiosity_meshes.h"

namespace {

using namespace limn;
using namespace limn::radiosity;

/// About `count` surfels, three fifths of them on the body.
Surfels bodyOverFloor(int count) {
  const int rings = static_cast<int>(std::sqrt(count * 0.3)), side = static_cast<int>(std::sqrt(count * 0.4));
  const auto body = [](float u, float v) {
    const float azimuth = 2 * glsl::pi * (u == 1 ? 0 : u), polar = glsl::pi * v;
    const float r = 0.5f * (1 + 0.25f * std::sin(3 * azimuth) * std::sin(polar) * std::sin(4 * polar));
    return glm::vec3(r * std::sin(polar) * std::cos(azimuth), 0.75f - r * std::cos(polar),
                     -r * std::sin(polar) * std::sin(azimuth));
  };
  const auto normal = [&](float u, float v) {
    constexpr float step = 1e-3f;
    const float w = std::clamp(v, 0.01f, 0.99f);
    return glm::normalize(
        glm::cross(body(u + step, w) - body(u - step, w), body(u, w + step) - body(u, w - step)));
  };
  return surfelsOf(
      {gridMesh(2 * rings, rings, body, normal), rectangleMesh({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, side)});
}

LinkSettings settingsOf(const benchmark::State& state) {
  return {.fill = state.range(1) == 1 ? Fill::centre : Fill::footprint,
          .opening = state.range(1) == 1 ? 1.f : 2.f};
}

void update(benchmark::State& state) {
  const Surfels surfels = bodyOverFloor(static_cast<int>(state.range(0)));
  Forest forest(surfels);
  for (auto _ : state) forest.refit(surfels);
}

double median(const std::vector<double>& values) {
  return render::quartiles(values).median;
}

/// Through the hierarchy and for every pair in turns: medians, and that of the turns' ratios.
void links(benchmark::State& state) {
  const Forest forest(bodyOverFloor(static_cast<int>(state.range(0))));
  Links made;
  std::vector<double> hierarchical, flat, ratios;
  const auto time = [](const auto& work) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  };
  made.build(forest, settingsOf(state));
  for (auto _ : state) {
    hierarchical.push_back(time([&] { made.build(forest, settingsOf(state)); }));
    flat.push_back(time([&] { made.buildFlat(forest, settingsOf(state)); }));
    ratios.push_back(flat.back() / hierarchical.back());
  }
  state.counters["elements"] = static_cast<double>(forest.leafOf().size());
  state.counters["hierarchical_ms"] = median(hierarchical);
  state.counters["every_pair_ms"] = median(flat);
  state.counters["ratio"] = median(ratios);
}

void illumination(benchmark::State& state) {
  const Forest forest(bodyOverFloor(static_cast<int>(state.range(0))));
  Links made;
  made.build(forest, settingsOf(state));
  std::vector<glm::vec3> outgoing(forest.slots(), glm::vec3(0.5f)), irradiance(forest.leafSlots());
  const std::vector<glm::vec4> table = binTable(made.resolution());
  for (auto _ : state) {
    gather(forest, made, table, outgoing, {}, irradiance);
    std::copy(irradiance.begin(), irradiance.end(), outgoing.begin());
    pullUp(forest, outgoing);
  }
}

scene::Scene sceneOf(const std::string& name) {
  return scene::load(std::filesystem::path(LIMN_ASSETS) / name / (name + ".glb"));
}

/// Path-traced irradiance of every vertex: direct light, which sends the bounce on, and the bounce from two
/// seeds.
struct VertexLight {
  VertexLight(const scene::Scene& scene, const scene::Pose& pose, float longestEdge) {
    const auto points = reference::vertexPoints(scene, pose, longestEdge);
    const auto trace = [&](Term term, uint64_t seed) {
      reference::Request request{
          .scene = scene, .pose = pose, .camera = {}, .progress = {}, .checkpoint = {}};
      request.term = term;
      request.bounces = reference::defaultBounces(term);
      request.spp = 1024;
      request.seed = seed;
      return reference::irradianceAt(request, points, 1e-4f * pose.bounds.radius());
    };
    direct = trace(Term::direct, 0);
    indirect = trace(Term::indirect, 0);
    again = trace(Term::indirect, 1);
  }
  std::vector<glm::vec3> direct, indirect, again;  ///< of each surfel
};

/// RMSE of the irradiance by one bounce over vertices against path tracing, relative to the mean irradiance
/// with direct light, of which `bounced` is the bounce's part: of all vertices, of those that any light
/// reaches (others lie within bodies), of the 97 % with the smallest error; and the path tracer's own noise.
/// Arguments: bins, Fill.
void vertices(benchmark::State& state, const char* name) {
  const scene::Scene scene = sceneOf(name);
  const scene::Pose pose = scene::evaluate(scene, 0);
  constexpr float longestEdge = 0.03f;  // the technique's default
  const auto fill = static_cast<Fill>(state.range(1));
  const SceneElements elements(scene, pose, longestEdge, 1u << 20, kDefaultLift,
                               fill == Fill::triangles ? LeafShape::triangles : LeafShape::disc);
  static std::map<std::string, VertexLight> truths;  // of minutes each
  const VertexLight& truth = truths.try_emplace(name, scene, pose, longestEdge).first->second;
  const Forest& forest = elements.forest();
  const auto leafOf = forest.leafOf();
  std::vector<glm::vec3> outgoing(forest.slots(), glm::vec3(0)), irradiance(forest.leafSlots());
  Links made;
  for (auto _ : state) {
    for (size_t i = 0; i < leafOf.size(); ++i)
      outgoing[leafOf[i]] = elements.leaves()[leafOf[i]].albedo * truth.direct[i] / glsl::pi;
    pullUp(forest, outgoing);
    made.build(forest, {.resolution = static_cast<int>(state.range(0)), .fill = fill});
    gather(forest, made, binTable(made.resolution()), outgoing, {}, irradiance);
  }
  double all = 0, lit = 0, noise = 0, sum = 0, bounced = 0;
  size_t enclosed = 0;
  std::vector<double> squares;
  const auto length2 = [](const glm::vec3& v) { return static_cast<double>(glm::dot(v, v)); };
  for (size_t i = 0; i < leafOf.size(); ++i) {
    const double square = length2(irradiance[leafOf[i]] - truth.indirect[i]);
    squares.push_back(square);
    all += square;
    const bool dark = length2(truth.direct[i] + truth.indirect[i] + truth.again[i]) == 0;
    dark ? ++enclosed : lit += square;
    noise += 0.5 * length2(truth.again[i] - truth.indirect[i]);
    sum += glm::dot(truth.direct[i] + truth.indirect[i], glm::vec3(1));
    bounced += glm::dot(truth.indirect[i], glm::vec3(1));
  }
  const auto count = static_cast<double>(leafOf.size());
  const double mean = sum / (3 * count);
  const auto relative = [&](double squared, double of) { return std::sqrt(squared / (3 * of)) / mean; };
  const auto most = static_cast<std::ptrdiff_t>(0.97 * count);
  std::ranges::sort(squares);
  state.counters["elements"] = count;
  state.counters["bounced"] = bounced / sum;
  state.counters["noise"] = relative(noise, count);
  state.counters["rmse"] = relative(all, count);
  state.counters["enclosed"] = static_cast<double>(enclosed) / count;
  state.counters["rmse_lit"] = relative(lit, count - static_cast<double>(enclosed));
  state.counters["rmse_97"] =
      relative(std::accumulate(squares.begin(), squares.begin() + most, 0.0), static_cast<double>(most));
}

/// Table 4.1 but for the illumination, which is the GPU's. Links told apart by their share of the cores'
/// time.
void monster(benchmark::State& state) {
  const scene::Scene scene = sceneOf("monster");
  const scene::Pose pose = scene::evaluate(scene, 0);
  SceneElements elements(scene, pose, 0.03f, 1u << 20);
  Links made;
  LinkTimes all;
  double updating = 0, linking = 0;
  for (auto _ : state) {
    const auto begin = std::chrono::steady_clock::now();
    elements.update(pose);
    const auto updated = std::chrono::steady_clock::now();
    made.build(elements.forest(), {.resolution = static_cast<int>(state.range(0))});
    const auto linked = std::chrono::steady_clock::now();
    updating += std::chrono::duration<double, std::milli>(updated - begin).count();
    linking += std::chrono::duration<double, std::milli>(linked - updated).count();
    all += made.times();
  }
  const auto frames = static_cast<double>(state.iterations());
  const double share = linking / frames / (all.create + all.inherit + all.refine + all.close);
  state.counters["elements"] = static_cast<double>(elements.forest().leafOf().size());
  state.counters["update_ms"] = updating / frames;
  state.counters["create_ms"] = share * all.create;
  state.counters["push_down_ms"] = share * all.inherit;
  state.counters["refine_ms"] = share * all.refine;
  state.counters["close_ms"] = share * all.close;
}

/// The thesis's 2.5k vertices, and up to 64k.
void sizes(benchmark::internal::Benchmark* b) {
  for (const int published : {0, 1})
    for (const int count : {2500, 8000, 16000, 32000, 64000}) b->Args({count, published});
  b->Unit(benchmark::kMillisecond)->UseRealTime();
}

void binsAndFills(benchmark::internal::Benchmark* b) {
  for (const Fill fill : {Fill::footprint, Fill::triangles})
    for (const int bins : {8, 12, 16, 24}) b->Args({bins, static_cast<int>(fill)});
}

BENCHMARK(update)->Apply(sizes);
BENCHMARK(links)->Apply(sizes)->Iterations(5);
BENCHMARK(illumination)->Apply(sizes);
BENCHMARK_CAPTURE(vertices, teapot_pattern, "teapot_pattern")->Apply(binsAndFills)->Iterations(1);
BENCHMARK_CAPTURE(vertices, frog, "frog")->Apply(binsAndFills)->Iterations(1);
BENCHMARK(monster)->Arg(8)->Arg(12)->Arg(16)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
