// How far the surfaces of a GPU picture are from those of its reference, channel by channel.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <vector>

#include "core/image/image.h"
#include "core/reference/reference.h"
#include "core/render/renderer.h"
#include "tests/gpu/render_test.h"

namespace limn::test {

struct Agreement {
  size_t covered = 0;          ///< pixels covered in either picture
  double maskedShare = 0;      ///< of these: coverage, id, or depth by more than 1e-3, differ
  double albedo = 0;           ///< mean absolute difference of a channel over the others
  double normalMedian = 0;     ///< degrees
  double normalTail = 0;       ///< degrees, 99th percentile
  double backgroundShare = 0;  ///< uncovered pixels whose channels other than R, G, B differ
};

inline Agreement agreement(const Image& image, const Image& reference) {
  const auto value = [](const Image& i, int x, int y, const char* name) {
    return i.at(x, y, i.channel(name));
  };
  const auto vector = [&](const Image& i, int x, int y, const std::array<const char*, 3>& names) {
    return glm::dvec3(value(i, x, y, names[0]), value(i, x, y, names[1]), value(i, x, y, names[2]));
  };
  constexpr std::array<const char*, 3> albedo{"albedo.R", "albedo.G", "albedo.B"},
      normal{"N.X", "N.Y", "N.Z"};
  Agreement result;
  std::vector<double> angles;
  size_t different = 0, background = 0;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      const bool a = value(image, x, y, "coverage") > 0.5f, b = value(reference, x, y, "coverage") > 0.5f;
      if (!a && !b) {
        for (const char* name : {"Z", "id", "albedo.R", "albedo.G", "albedo.B", "N.X", "N.Y", "N.Z"})
          if (value(image, x, y, name) != value(reference, x, y, name)) {
            ++background;
            break;
          }
        continue;
      }
      ++result.covered;
      const double z = value(image, x, y, "Z"), r = value(reference, x, y, "Z");
      if (a != b || value(image, x, y, "id") != value(reference, x, y, "id") ||
          !(std::abs(z - r) <= 1e-3 * r)) {
        ++different;
        continue;
      }
      const glm::dvec3 d = glm::abs(vector(image, x, y, albedo) - vector(reference, x, y, albedo));
      result.albedo += (d.x + d.y + d.z) / 3;
      const glm::dvec3 m = vector(image, x, y, normal), n = vector(reference, x, y, normal);
      angles.push_back(glm::degrees(std::atan2(glm::length(glm::cross(m, n)), glm::dot(m, n))));
    }
  }
  const size_t uncovered = image.pixelCount() - result.covered;
  if (uncovered > 0) result.backgroundShare = double(background) / double(uncovered);
  if (result.covered > 0) result.maskedShare = double(different) / double(result.covered);
  if (angles.empty()) return result;
  result.albedo /= double(angles.size());
  std::sort(angles.begin(), angles.end());
  result.normalMedian = angles[angles.size() / 2];
  result.normalTail = angles[angles.size() * 99 / 100];
  return result;
}

struct Pair {
  Image image, reference;
};

/// One term of a scene by both renderers, without techniques (V = 1); the reference with `spp` samples.
inline Pair renderBoth(gpu::Device& device, const scene::Scene& scene, const scene::Pose& pose,
                       const scene::CameraPose& camera, glm::ivec2 size, Term term, int spp, double time = 0,
                       int animation = scene::kNone) {
  render::Renderer renderer(device, scene);
  render::Settings settings;
  settings.size = size;
  settings.term = term;
  settings.channels = true;
  renderer.configure(settings);
  renderer.setTime(time, animation);
  renderer.setCamera(camera);
  renderer.render();
  return {renderer.read(), reference::render(request(scene, pose, camera, size, term, spp)).image};
}

}  // namespace limn::test
