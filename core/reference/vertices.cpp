#include "core/reference/vertices.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <limits>

#include "core/base/error.h"
#include "core/radiosity/scene_elements.h"
#include "core/reference/integrator.h"

namespace limn::reference {
namespace {

constexpr int rowLength = 1024;

Surface whiteSurface(const SurfacePoint& point, float clearance) {
  Surface s;
  s.position = point.position;
  s.view = point.normal;
  s.rayOffset = clearance;
  s.values.normal = s.values.geometric_normal = point.normal;
  s.values.base_colour = glm::vec3(1);
  s.values.roughness = 1;
  s.brdf = glsl::surface_brdf(glm::vec3(1), 0, 1, 0, glm::vec3(1), 1.5f);
  return s;
}

}  // namespace

std::vector<glm::vec3> irradianceAt(const Request& request, std::span<const SurfacePoint> points,
                                    float clearance) {
  if (request.term != Term::direct && request.term != Term::indirect && request.term != Term::final)
    throw UsageError("reference: at vertices there are the terms direct, indirect and final");
  const RayScene rays(request.scene, request.pose);
  const auto integrator = makePathIntegrator(rays, request);
  std::vector<glm::vec3> result(points.size());
  tbb::task_arena arena(request.threads > 0 ? request.threads : tbb::task_arena::automatic);
  arena.execute([&] {
    tbb::parallel_for(size_t{0}, points.size(), [&](size_t i) {
      Sums sums{};
      Sampler sampler(request.seed, i, 0);
      integrator->sample(whiteSurface(points[i], clearance), sampler, 0, static_cast<uint32_t>(request.spp),
                         sums);
      result[i] = glsl::pi * glm::vec3(integrator->estimate(sums, request.spp));
    });
  });
  return result;
}

std::vector<SurfacePoint> vertexPoints(const scene::Scene& scene, const scene::Pose& pose,
                                       float longestEdge) {
  const radiosity::SceneElements elements(scene, pose, longestEdge, std::numeric_limits<uint32_t>::max());
  std::vector<SurfacePoint> points;
  for (const uint32_t leaf : elements.forest().leafOf())
    points.push_back(
        {glm::vec3(elements.leaves()[leaf].position), glm::vec3(elements.leaves()[leaf].normal)});
  return points;
}

Image vertexImage(std::span<const SurfacePoint> points, std::span<const glm::vec3> irradiance) {
  const int count = static_cast<int>(points.size());
  Image image(std::clamp(count, 1, rowLength), std::max(1, (count + rowLength - 1) / rowLength),
              {"R", "G", "B", "P.X", "P.Y", "P.Z", "N.X", "N.Y", "N.Z", "coverage"});
  for (int i = 0; i < count; ++i) {
    const std::span<float> pixel = image.pixel(i % rowLength, i / rowLength);
    for (int c = 0; c < 3; ++c) {
      pixel[static_cast<size_t>(c)] = irradiance[static_cast<size_t>(i)][c];
      pixel[static_cast<size_t>(3 + c)] = points[static_cast<size_t>(i)].position[c];
      pixel[static_cast<size_t>(6 + c)] = points[static_cast<size_t>(i)].normal[c];
    }
    pixel[9] = 1;
  }
  return image;
}

}  // namespace limn::reference
