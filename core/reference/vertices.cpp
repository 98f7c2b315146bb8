#include "core/reference/vertices.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/question/term.h"
#include "core/radiosity/scene_elements.h"
#include "core/reference/private/direct_light.h"
#include "core/reference/private/validate.h"

namespace limn::reference {
namespace {

constexpr int kRowLength = 1024;
constexpr uint32_t kMostPoints = kRowLength * kMaxImageSide;
constexpr TermSet kVertexTerms = Term::final | Term::direct | Term::indirect;

Surface whiteSurface(const SurfacePoint& point, float clearance) {
  Surface s;
  s.position = point.position;
  s.view = point.normal;
  s.rayOffset = clearance;
  s.draw = glsl::no_instance;
  s.values.normal = s.values.geometric_normal = point.normal;
  s.values.base_colour = glm::vec3(1);
  s.values.roughness = 1;
  s.brdf = glsl::surface_brdf(glm::vec3(1), 0, 1, 0, glm::vec3(1), 1.5f);
  return s;
}

/// A part of a second's work, so that progress is seen, and enough of it to keep all cores busy.
uint32_t samplesPerPass(const Request& request, size_t points) {
  const double work = static_cast<double>(points) * raysOfSample(request);
  return static_cast<uint32_t>(std::clamp(0x1p21 / std::max(work, 1.0), 1.0, 1024.0));
}

}  // namespace

std::vector<glm::vec3> irradianceAt(const Request& request, std::span<const SurfacePoint> points,
                                    float clearance) {
  if (!contains(kVertexTerms, request.term))
    throw UsageError(
        fmt::format("reference: at vertices there are the terms {}", joined(termNames(kVertexTerms))));
  checkLight(request);
  const RayScene rays(request.scene, request.pose, request.unshadowed);
  const auto integrator = makePathIntegrator(rays, request);
  const auto wanted = static_cast<uint32_t>(request.spp);
  const uint32_t passSize = samplesPerPass(request, points.size());
  std::vector<Sums> sums(points.size());
  tbb::task_arena arena(request.threads > 0 ? request.threads : tbb::task_arena::automatic);
  const auto start = std::chrono::steady_clock::now();
  for (uint32_t done = 0; done < wanted;) {
    const uint32_t count = std::min(passSize, wanted - done);
    arena.execute([&] {
      tbb::parallel_for(size_t{0}, points.size(), [&](size_t i) {
        Sampler sampler(request.seed, i, 0);
        integrator->sample(whiteSurface(points[i], clearance), sampler, done, count, sums[i]);
      });
    });
    done += count;
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
    const Progress progress{.fraction = static_cast<double>(done) / wanted,
                            .secondsLeft = spent.count() / done * (wanted - done),
                            .spp = static_cast<int>(done)};
    if (request.progress && !request.progress(progress) && done < wanted)
      throw Error(fmt::format("reference: stopped after {} of {} samples per point", done, wanted));
  }
  std::vector<glm::vec3> result;
  for (const Sums& sum : sums) result.push_back(glsl::pi * glm::vec3(integrator->estimate(sum, request.spp)));
  return result;
}

std::vector<SurfacePoint> vertexPoints(const scene::Scene& scene, const scene::Pose& pose,
                                       float longestEdge) {
  const radiosity::SceneElements elements(scene, pose, longestEdge, kMostPoints);
  std::vector<SurfacePoint> points;
  for (const uint32_t leaf : elements.forest().leafOf())
    points.push_back(
        {glm::vec3(elements.leaves()[leaf].position), glm::vec3(elements.leaves()[leaf].normal)});
  return points;
}

Image vertexImage(std::span<const SurfacePoint> points, std::span<const glm::vec3> irradiance,
                  const glm::dvec3& origin) {
  std::vector<std::string> channels{"R", "G", "B", "P.X", "P.Y", "P.Z", "N.X", "N.Y", "N.Z", "coverage"};
  const bool far = origin != glm::dvec3(0);
  if (far) channels.insert(channels.end(), {"P.rest.X", "P.rest.Y", "P.rest.Z"});
  const int count = static_cast<int>(points.size());
  Image image(std::clamp(count, 1, kRowLength), std::max(1, (count + kRowLength - 1) / kRowLength),
              std::move(channels));
  for (int i = 0; i < count; ++i) {
    const std::span<float> pixel = image.pixel(i % kRowLength, i / kRowLength);
    const SurfacePoint& point = points[static_cast<size_t>(i)];
    const glm::dvec3 position = origin + glm::dvec3(point.position);
    const glm::vec3 rounded(position), rest(position - glm::dvec3(rounded));
    for (int c = 0; c < 3; ++c) {
      pixel[static_cast<size_t>(c)] = irradiance[static_cast<size_t>(i)][c];
      pixel[static_cast<size_t>(3 + c)] = rounded[c];
      pixel[static_cast<size_t>(6 + c)] = point.normal[c];
      if (far) pixel[static_cast<size_t>(10 + c)] = rest[c];
    }
    pixel[9] = 1;
  }
  return image;
}

}  // namespace limn::reference
