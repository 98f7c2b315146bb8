#include "core/scene/framing.h"

#include <algorithm>
#include <cstddef>
#include <glm/glm.hpp>
#include <limits>
#include <vector>

#include "core/scene/camera.h"
#include "core/scene/draw_instance.h"

namespace limn::scene {
namespace {

constexpr double kFilled = 0.8;  // of a square picture's side
constexpr double kLowest = std::numeric_limits<double>::lowest();
constexpr int kTimes = 8;                                    // of an animation
constexpr std::size_t kMostVertices = std::size_t{4} << 20;  // of them; of more, every n-th one

glm::dmat3 viewRotation(const glm::vec3& back) {
  return glm::dmat3(glm::mat3(lookAt(back, glm::vec3(0), 1.f).worldToView));
}

/// Calls visit() with vertices in the world: all, or an even part of very many.
template <class Visit>
void visitVertices(const Scene& scene, const Pose& pose, const Visit& visit) {
  std::size_t count = 0;
  for (const DrawInstance& instance : pose.instances)
    count += primitiveOf(scene, pose, instance).positions.size();
  const std::size_t step = 1 + count / kMostVertices;
  std::vector<glm::vec3> moved, normals;
  std::vector<glm::vec4> tangents;
  for (const DrawInstance& instance : pose.instances) {
    const Primitive& primitive = primitiveOf(scene, pose, instance);
    const bool deformed = instance.deformed != kNone;
    if (deformed)
      deform(primitive, pose.deformed[static_cast<std::size_t>(instance.deformed)], moved, normals, tangents);
    const std::vector<glm::vec3>& positions = deformed ? moved : primitive.positions;
    for (std::size_t i = 0; i < positions.size(); i += step)
      visit(glm::vec3(instance.objectToWorld * glm::vec4(positions[i], 1)));
  }
}

}  // namespace

Framing::Framing(const glm::vec3& back, float yfov)
    : toView_(viewRotation(back)),
      tangent_(kFilled * glm::tan(0.5 * yfov)),
      yfov_(yfov),
      right_(kLowest),
      left_(kLowest) {}

void Framing::add(const glm::vec3& point) {
  const glm::dvec3 p = toView_ * glm::dvec3(point);
  view_.add(glm::vec3(p));
  right_ = glm::max(right_, glm::dvec2(p) + tangent_ * p.z);
  left_ = glm::max(left_, -glm::dvec2(p) + tangent_ * p.z);
}

void Framing::add(const Bounds& bounds) {
  if (bounds.empty()) return;
  for (int corner = 0; corner < 8; ++corner)
    add({(corner & 1) ? bounds.high.x : bounds.low.x, (corner & 2) ? bounds.high.y : bounds.low.y,
         (corner & 4) ? bounds.high.z : bounds.low.z});
}

// A point p is seen from c where |p.x - c.x| <= t (c.z - p.z), that is where t c.z is at least
// (p.x + t p.z) - c.x and (-p.x + t p.z) + c.x. The least c.z is half the sum of the maxima of the two
// brackets, with c.x half their difference; y goes the same way.
CameraPose Framing::camera() const {
  glm::dvec3 eye(0, 0, 1);
  double depth = 1;
  if (!view_.empty()) {
    // Of a point, so far that the eye is another one in single precision.
    const double nearest =
        std::max({0.01 * view_.radius(), 1e-4 * glm::length(glm::dvec3(view_.centre())), 1e-20});
    const glm::dvec2 least = 0.5 * (right_ + left_) / tangent_;
    eye = glm::dvec3(0.5 * (right_ - left_),
                     std::max({least.x, least.y, static_cast<double>(view_.high.z) + nearest}));
    depth = eye.z - view_.centre().z;
  }
  const glm::dmat3 toWorld = glm::transpose(toView_);
  return lookAt(glm::vec3(toWorld * eye), glm::vec3(toWorld * (eye - glm::dvec3(0, 0, depth))), yfov_);
}

CameraPose frameScene(const Scene& scene, int animation) {
  Framing framing;
  const auto played = static_cast<std::size_t>(std::max(animation, 0));
  const bool moves = played < scene.animations.size();  // evaluate() refuses what does not exist
  const int times = moves ? kTimes : 1;
  const double duration = moves ? scene.animations[played].duration : 0;
  Pose pose;
  for (int i = 0; i < times; ++i) {
    evaluate(scene, duration * i / times, animation, pose);
    visitVertices(scene, pose, [&](const glm::vec3& point) { framing.add(point); });
  }
  return framing.camera();
}

Bounds vertexBounds(const Scene& scene, const Pose& pose) {
  Bounds bounds;
  visitVertices(scene, pose, [&](const glm::vec3& point) { bounds.add(point); });
  return bounds;
}

}  // namespace limn::scene
