#include "apps/chapters/support/window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <sstream>

#include "core/context/context.h"
#include "core/gpu/device.h"
#include "core/render/renderer.h"
#include "core/scene/camera.h"
#include "core/technique/registry.h"

namespace limn::app {
namespace {

/// The camera on a sphere around the point it looks at.
struct Orbit {
  glm::vec3 centre{0};
  float distance = 1, azimuth = 0, elevation = 0, yfov = 0.8f, near = 0.01f;

  Orbit(const scene::CameraPose& camera, const scene::Bounds& bounds) : yfov(camera.yfov), near(camera.near) {
    const glm::mat4 toWorld = glm::inverse(camera.worldToView);
    const glm::vec3 eye(toWorld[3]), forward = -glm::vec3(toWorld[2]);
    centre = eye + std::max(glm::dot(bounds.centre() - eye, forward), near) * forward;
    distance = glm::distance(eye, centre);
    azimuth = std::atan2(-forward.x, -forward.z);
    elevation = std::asin(std::clamp(-forward.y, -1.f, 1.f));
  }

  void turn(float right, float up) {
    azimuth -= right;
    elevation = std::clamp(elevation + up, -1.5f, 1.5f);
  }
  void approach(float factor) { distance = std::max(distance * factor, 2 * near); }

  scene::CameraPose camera() const {
    const glm::vec3 back(std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                         std::cos(elevation) * std::cos(azimuth));
    scene::CameraPose pose = scene::lookAt(centre + distance * back, centre, yfov);
    pose.near = near;
    return pose;
  }
};

std::vector<render::TechniqueUse> techniquesOf(const ChapterSetting& setting,
                                               const TechniqueRegistry& registry) {
  TechniqueOptions options;
  options.techniques = setting.techniques;
  std::istringstream words(setting.parameters);
  for (std::string word; words >> word;) options.settings.push_back(word);
  return options.resolve(registry);
}

class Window {
 public:
  Window(const Chapter& chapter, const SceneOptions& scene)
      : chapter_(chapter),
        view_(open(scene)),
        context_(Context::create({.backend = Backend::glfw,
                                  .width = view_.size.x,
                                  .height = view_.size.y,
                                  .title = chapter.title})),
        device_(*context_),
        registry_(TechniqueRegistry::defaultFolders()),
        renderer_(device_, view_.scene),
        orbit_(view_.camera, view_.pose.bounds) {
    GLFWwindow* window = context_->window();
    glfwSetWindowUserPointer(window, this);
    glfwSetKeyCallback(window, [](GLFWwindow* w, int key, int, int action, int) {
      if (action != GLFW_RELEASE) self(w).press(key);
    });
    glfwSetScrollCallback(window, [](GLFWwindow* w, double, double turns) {
      self(w).orbit_.approach(std::pow(0.9f, static_cast<float>(turns)));
    });
    choose(0);
  }

  void run(int frames) {
    GLFWwindow* window = context_->window();
    auto last = std::chrono::steady_clock::now();
    for (int i = 0; (frames == 0 || i < frames) && !glfwWindowShouldClose(window); ++i) {
      glfwPollEvents();
      drag();
      const auto now = std::chrono::steady_clock::now();
      const double seconds = std::chrono::duration<double>(now - last).count();
      last = now;
      if (!paused_) time_ += seconds;
      draw();
      glfwSwapBuffers(window);
      glfwSetWindowTitle(window, fmt::format("{}: {}, {:.1f} ms", chapter_.title,
                                             chapter_.settings[setting_].title, 1000 * seconds)
                                     .c_str());
    }
  }

 private:
  static Window& self(GLFWwindow* window) { return *static_cast<Window*>(glfwGetWindowUserPointer(window)); }

  void choose(size_t setting) {
    if (setting >= chapter_.settings.size()) return;
    setting_ = setting;
    configured_ = false;
  }

  void press(int key) {
    constexpr float step = 0.05f;
    if (key >= GLFW_KEY_1 && key <= GLFW_KEY_9) choose(static_cast<size_t>(key - GLFW_KEY_1));
    if (key == GLFW_KEY_SPACE) choose((setting_ + 1) % chapter_.settings.size());
    if (key == GLFW_KEY_P) paused_ = !paused_;
    if (key == GLFW_KEY_LEFT) orbit_.turn(-step, 0);
    if (key == GLFW_KEY_RIGHT) orbit_.turn(step, 0);
    if (key == GLFW_KEY_UP) orbit_.turn(0, step);
    if (key == GLFW_KEY_DOWN) orbit_.turn(0, -step);
    if (key == GLFW_KEY_ESCAPE) glfwSetWindowShouldClose(context_->window(), GLFW_TRUE);
  }

  void drag() {
    double x = 0, y = 0;
    glfwGetCursorPos(context_->window(), &x, &y);
    const glm::vec2 cursor(x, y), moved = cursor - cursor_;
    cursor_ = cursor;
    if (glfwGetMouseButton(context_->window(), GLFW_MOUSE_BUTTON_LEFT) == GLFW_PRESS)
      orbit_.turn(0.01f * moved.x, 0.01f * moved.y);
  }

  void draw() {
    glm::ivec2 size(0);
    glfwGetFramebufferSize(context_->window(), &size.x, &size.y);
    if (size.x < 1 || size.y < 1) return;  // minimised
    if (!configured_ || size != shown_.size) {
      shown_.size = size;
      shown_.techniques = techniquesOf(chapter_.settings[setting_], registry_);
      shown_.dynamic = false;  // what did not change is not drawn again
      shown_.displayEv = 0;
      renderer_.configure(shown_);
      configured_ = true;
    }
    renderer_.setTime(time_, view_.animation);
    renderer_.setCamera(orbit_.camera());
    renderer_.render();
    renderer_.present();
  }

  const Chapter& chapter_;
  View view_;
  std::unique_ptr<Context> context_;
  gpu::Device device_;
  TechniqueRegistry registry_;
  render::Renderer renderer_;
  Orbit orbit_;
  render::Settings shown_;
  size_t setting_ = 0;
  bool configured_ = false, paused_ = false;
  double time_ = 0;
  glm::vec2 cursor_{0};
};

}  // namespace

void showWindow(const Chapter& chapter, const SceneOptions& scene, int frames) {
  Window(chapter, scene).run(frames);
}

}  // namespace limn::app
