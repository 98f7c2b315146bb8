#include "core/radiosity/occlusion.h"

#include "core/reference/private/ray_scene.h"

namespace limn::radiosity {
namespace {

class SceneOcclusion final : public Occlusion {
 public:
  SceneOcclusion(const scene::Scene& scene, const scene::Pose& pose) : rays_(scene, pose, false) {}
  bool blocked(const glm::vec3& origin, const glm::vec3& direction, float end) const override {
    return rays_.occluded(origin, direction, end);
  }
  glm::vec3 transmittance(const glm::vec3& origin, const glm::vec3& direction, float end) const override {
    return rays_.medium().transmittance(origin, direction, end);
  }

 private:
  reference::RayScene rays_;
};

}  // namespace

std::unique_ptr<Occlusion> sceneOcclusion(const scene::Scene& scene, const scene::Pose& pose) {
  return std::make_unique<SceneOcclusion>(scene, pose);
}

}  // namespace limn::radiosity
