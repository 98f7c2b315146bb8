#include "apps/view/viewer.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

#include "apps/view/difference.h"
#include "apps/view/display_image.h"
#include "apps/view/viewer_window.h"
#include "core/base/error.h"
#include "core/base/text.h"

namespace limn::app {
namespace {

constexpr double restAfter = 0.25;    // seconds without a change
constexpr double fluentMs = 60;       // a frame while things move
constexpr double idleSeconds = 0.05;  // between looks at the reference's progress
constexpr double reloadSeconds = 0.5;
constexpr int largestReduction = 4;

void setText(char (&target)[1024], const std::string& text) {
  target[text.copy(target, sizeof target - 1)] = 0;
}

/// What the reference is asked for where the picture shows `output`.
reference::Term termOf(render::Output output) {
  return reference::termFromName(std::string(render::name(output)));
}

/// One where the picture has indirect light in it.
int bouncesOf(const ViewState& state) {
  const auto indirect = [](const render::TechniqueUse& use) {
    return contains(use.plugin->info->terms, Term::indirect);
  };
  if (!reference::hasBounces(termOf(state.output))) return 0;
  return state.output == render::Output::indirect || std::ranges::any_of(state.techniques, indirect) ? 1 : 0;
}

}  // namespace

ViewerWindow::ViewerWindow(const ViewerOptions& options)
    : options_(options), registry_(TechniqueRegistry::defaultFolders()) {
  state_.scene = options.scene;
  state_.output = render::parseOutput(options.outputTerm);
  state_.exposure = static_cast<float>(options.exposure);
  state_.techniques = resolve(options.techniques);
  const glm::ivec2 size = parseSize(options.scene.size);
  context_ = Context::create({.backend = Backend::glfw,
                              .debug = options.debug,
                              .width = size.x,
                              .height = size.y,
                              .title = options.title});
  device_ = std::make_unique<gpu::Device>(*context_);
  openScene(state_.scene);
  if (!options_.steps.empty()) chooseStep(0);
  setText(saveText_, options_.save.string());

  GLFWwindow* window = context_->window();
  glfwSetWindowUserPointer(window, this);
  // ImGui knows only whether a key is down when a frame begins; software renderers' frames are longer than
  // taps.
  glfwSetKeyCallback(window, [](GLFWwindow* w, int key, int, int action, int modifiers) {
    auto& self = *static_cast<ViewerWindow*>(glfwGetWindowUserPointer(w));
    if (action == GLFW_PRESS) self.pressed_.emplace_back(key, (modifiers & GLFW_MOD_CONTROL) != 0);
  });
  glfwSetDropCallback(window, [](GLFWwindow* w, int count, const char** files) {
    auto& self = *static_cast<ViewerWindow*>(glfwGetWindowUserPointer(w));
    if (count < 1) return;
    SceneOptions wanted;
    wanted.scene = files[0];
    wanted.size = self.state_.scene.size;
    self.tryOpen(wanted);
  });
  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;  // the layout is fixed: nothing to remember
  ImGui::StyleColorsDark();
  ImGui_ImplGlfw_InitForOpenGL(window, true);
  ImGui_ImplOpenGL3_Init("#version 450 core");
}

ViewerWindow::~ViewerWindow() {
  reference_.stop();
  ImGui_ImplOpenGL3_Shutdown();
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
}

std::vector<render::TechniqueUse> ViewerWindow::resolve(const TechniqueOptions& options) const {
  return options.resolve(registry_);
}

/// Replaces what is shown; leaves everything as it is when that throws.
void ViewerWindow::openScene(const SceneOptions& wanted) {
  auto view = std::make_shared<View>(open(wanted));
  auto picture = std::make_unique<ShownPicture>(*device_, *view, options_.shaders);
  reference_.stop();
  other_.reset();
  picture_ = std::move(picture);
  view_ = std::move(view);
  state_.scene = wanted;
  orbit_ = Orbit(view_->camera, view_->pose.bounds);
  camera_ = view_->camera;
  setText(sceneText_, wanted.scene.string());
  setText(environmentText_, wanted.environment.string());
  moved();
}

void ViewerWindow::tryOpen(const SceneOptions& wanted) {
  try {
    openScene(wanted);
    message_ = "opened " + wanted.scene.string();
  } catch (const Error& error) {
    message_ = error.what();
  }
}

void ViewerWindow::moved() {
  dirty_ = true;
  compared_ = false;
  metrics_.reset();
  truth_.reset();
  reference_.forget();
  lastChange_ = glfwGetTime();
}

bool ViewerWindow::atRest() const {
  return !playing_ && !dirty_ && reduction_ == 1;
}

glm::ivec2 ViewerWindow::renderSize() const {
  return glm::max(area_ / reduction_, glm::ivec2(1));
}

void ViewerWindow::renderPictures() {
  if (area_.x < 1 || area_.y < 1) return;  // minimised
  const double now = glfwGetTime();
  const bool moving = playing_ || now - lastChange_ < restAfter;
  int wanted = 1;
  if (moving)
    while (wanted < largestReduction && fullMs_ / (wanted * wanted) > fluentMs) wanted *= 2;
  if (wanted != reduction_ || renderSize() != picture_->size()) dirty_ = true;
  reduction_ = wanted;
  if (!dirty_ && !playing_) return;
  dirty_ = false;

  render::Settings settings;
  settings.size = renderSize();
  settings.output = state_.output;
  settings.light = view_->light;
  settings.displayEv = state_.exposure;
  settings.techniques = state_.techniques;
  picture_->configure(settings);
  double ms = 0;
  if (picture_->render(camera_, state_.scene.time, view_->animation, framesPanelOpen_))
    ms = picture_->frameMs();
  if (beside_ == Beside::techniques) {
    if (!other_) other_ = std::make_unique<ShownPicture>(*device_, *view_, options_.shaders);
    settings.techniques = otherTechniques_;
    other_->configure(settings);
    if (other_->render(camera_, state_.scene.time, view_->animation, false)) ms += other_->frameMs();
  }
  fullMs_ = ms * reduction_ * reduction_;
}

/// Errors are measured only when nothing moves: reading a picture back waits for the GPU.
void ViewerWindow::compareAtRest() {
  if (beside_ == Beside::reference && picture_->display() != nullptr) {
    if (!reference_.running() && !truth_ && reference_.state().spp == 0 &&
        reference_.state().problem.empty()) {
      view_->pose = picture_->renderer().pose();
      reference_.start(view_, camera_, picture_->size(), termOf(state_.output), bouncesOf(state_));
    }
    if (std::optional<Image> finer = reference_.take()) {
      truth_ = std::move(finer);
      truthTexture_ = toTexture(*device_, toneMapped(*truth_, state_.exposure));
      compared_ = false;
    }
  }
  if (compared_) return;
  std::optional<Image> against;
  if (beside_ == Beside::reference) against = truth_;
  if (beside_ == Beside::techniques && other_ && other_->display() != nullptr) against = other_->read();
  if (!against || picture_->display() == nullptr) return;
  compared_ = true;
  try {
    const Image image = picture_->read();
    metrics_ = compareImages(image, *against,
                             {.exposureEv = state_.exposure, .useMask = false, .maskTermRange = {}});
    differenceTexture_ = toTexture(*device_, signedDifference(image, *against, {}));
  } catch (const Error& error) {
    message_ = error.what();
  }
}

void ViewerWindow::frame() {
  const double now = glfwGetTime();
  if (playing_) {
    state_.scene.time += now - lastFrame_;
    compared_ = false;
  }
  lastFrame_ = now;
  if (!options_.shaders.empty() && now - lastReload_ > reloadSeconds) {
    lastReload_ = now;
    if (picture_->reloadShaders()) dirty_ = true;
  }
  // Before anything is laid out: textures that the layout refers to must live until it is drawn.
  renderPictures();
  if (atRest()) {
    compareAtRest();
    if (savePending_) save();
  }
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGui::NewFrame();
  panels();
  pictureArea();
  ImGui::Render();
  glm::ivec2 size(0);
  glfwGetFramebufferSize(context_->window(), &size.x, &size.y);
  const gl::Functions& gl = context_->gl();
  gl.BindFramebuffer(GL_FRAMEBUFFER, 0);
  gl.Viewport(0, 0, size.x, size.y);
  const GLfloat background[4] = {0.1f, 0.1f, 0.1f, 1};
  gl.ClearBufferfv(GL_COLOR, 0, background);
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

void ViewerWindow::saveScreenshot(const std::filesystem::path& file) const {
  glm::ivec2 size(0);
  glfwGetFramebufferSize(context_->window(), &size.x, &size.y);
  std::vector<uint8_t> pixels(static_cast<size_t>(size.x) * static_cast<size_t>(size.y) * 3);
  const gl::Functions& gl = context_->gl();
  gl.PixelStorei(GL_PACK_ALIGNMENT, 1);
  gl.ReadPixels(0, 0, size.x, size.y, GL_RGB, GL_UNSIGNED_BYTE, pixels.data());
  gl.PixelStorei(GL_PACK_ALIGNMENT, 4);
  writePng(file, fromBottomFirst(size, pixels));
}

void ViewerWindow::run() {
  GLFWwindow* window = context_->window();
  for (int i = 0; (options_.frames == 0 || i < options_.frames) && glfwWindowShouldClose(window) == 0; ++i) {
    // Nothing moves: wait for a hand, or for the reference.
    const bool busy = playing_ || dirty_ || glfwGetTime() - lastChange_ < 2 * restAfter;
    if (busy)
      glfwPollEvents();
    else
      glfwWaitEventsTimeout(idleSeconds);
    frame();
    const bool last = i + 1 == options_.frames || glfwWindowShouldClose(window) != 0;
    if (last && !options_.screenshot.empty()) saveScreenshot(options_.screenshot);
    glfwSwapBuffers(window);
    const std::vector<std::string> errors = context_->takeErrors();
    if (!errors.empty()) throw Error("OpenGL: " + errors.front());
  }
}

void runViewer(const ViewerOptions& options) {
  ViewerWindow(options).run();
}

}  // namespace limn::app
