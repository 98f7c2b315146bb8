#include "apps/view/viewer.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <fmt/format.h>
#include <imgui.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>

#include "apps/view/display_image.h"
#include "apps/view/pace.h"
#include "apps/view/recent_scenes.h"
#include "apps/view/viewer_style.h"
#include "apps/view/viewer_window.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "core/question/question_fields.h"
#include "core/scene_io/load.h"
#include "core/session/find.h"

namespace limn::app {
namespace {

constexpr double kRestAfter = 0.25;    // seconds without a change
constexpr double kMessageSeconds = 5;  // for which a result is said

/// Resident memory of the process, MiB.
double residentMiB() {
  long total = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> total >> resident;
  return static_cast<double>(resident) * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1 << 20);
}

Beside besideNamed(const std::string& name) {
  return name == "techniques" ? Beside::techniques : name == "truth" ? Beside::reference : Beside::nothing;
}

/// Of text and widgets, for windows on the first monitor.
float monitorScale() {
  float x = 1, y = 1;
  GLFWmonitor* monitor = glfwInit() ? glfwGetPrimaryMonitor() : nullptr;
  if (monitor != nullptr) glfwGetMonitorContentScale(monitor, &x, &y);
  return std::max(x, 1.f);
}

/// The size of a window, as far as the first monitor has room for it.
glm::ivec2 fitted(glm::ivec2 window) {
  glm::ivec2 corner(0), room(0);
  GLFWmonitor* monitor = glfwInit() ? glfwGetPrimaryMonitor() : nullptr;
  if (monitor != nullptr) glfwGetMonitorWorkarea(monitor, &corner.x, &corner.y, &room.x, &room.y);
  return room.x > 0 && room.y > 0 ? glm::min(window, room) : window;
}

/// The letter that the keyboard's layout has on a key, else the key.
int letterOf(int key, int scancode) {
  const char* name = glfwGetKeyName(key, scancode);
  const bool letter = name != nullptr && *name >= 'a' && *name <= 'z' && name[1] == 0;
  return letter ? GLFW_KEY_A + (*name - 'a') : key;
}

}  // namespace

ViewerWindow::ViewerWindow(const ViewerOptions& options)
    : options_(options), registry_(TechniqueRegistry::defaultFolders(), warn) {
  state_.scene = options.scene;
  state_.tone = options.tone.fixed();
  state_.automaticExposure = options.tone.automatic();
  state_.techniques = options.techniques.resolve(registry_);
  state_.shaders = options.shaders;
  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;  // the layout is fixed: nothing to remember
  setStyle(options.scale > 0 ? static_cast<float>(options.scale) : monitorScale());
  panelWidth_ = scaled(kPanelWidth);
  const glm::ivec2 beside(scaled(kPanelWidth), scaled(kStatusHeight));
  const glm::ivec2 size = fitted(glm::ivec2(options.scene.width, options.scene.height) + beside);
  context_ = Context::create({.backend = Backend::glfw,
                              .debug = options.debug,
                              .width = size.x,
                              .height = size.y,
                              .title = options.title});
  device_ = std::make_unique<gpu::Device>(*context_);
  textures_ = std::make_unique<WindowTextures>(*device_);
  thread_ = std::make_unique<PictureThread>(
      PictureThreadOptions{options.device, options.debug, options.shaders, options.cache});
  ownScenes_ = session::sceneNames();
  aboutScenes_ = session::aboutScenes();
  recentScenes_ = recentScenes();
  if (!state_.scene.scene.empty()) postOpening({.scene = state_.scene, .needed = true});
  if (!options_.steps.empty()) state_.techniques = options_.steps.front().techniques.resolve(registry_);
  compareWith(besideNamed(options.compareWith));
  sceneText_ = options.scene.scene;
  saveText_ = options.save.string();
  listen();
  ImGui_ImplGlfw_InitForOpenGL(context_->window(), true);
  ImGui_ImplOpenGL3_Init("#version 450 core");
}

ViewerWindow::~ViewerWindow() {
  ImGui_ImplOpenGL3_Shutdown();
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
}

void ViewerWindow::listen() {
  GLFWwindow* window = context_->window();
  glfwSetWindowUserPointer(window, this);
  // ImGui knows only whether a key is down when a frame begins; taps may be shorter than a frame.
  glfwSetKeyCallback(window, [](GLFWwindow* w, int key, int scancode, int action, int modifiers) {
    auto& self = *static_cast<ViewerWindow*>(glfwGetWindowUserPointer(w));
    if (action == GLFW_RELEASE) return;
    self.tapped_.push_back(letterOf(key, scancode));
    const KeyPress pressed{letterOf(key, scancode), (modifiers & GLFW_MOD_CONTROL) != 0,
                           (modifiers & GLFW_MOD_SHIFT) != 0};
    const bool again = pressed.control && pressed.key == GLFW_KEY_Z;  // while it is held
    if (action == GLFW_REPEAT && !again) return;
    if (pressed.control && pressed.key == GLFW_KEY_Q) glfwSetWindowShouldClose(w, GLFW_TRUE);
    if (pressed.control && pressed.key == GLFW_KEY_O) self.browse();
    // The dialog has the keyboard while it is open.
    if (self.browsing_)
      self.dismissed_ = self.dismissed_ || pressed.key == GLFW_KEY_ESCAPE;
    else
      self.pressed_.push_back(pressed);
  });
  glfwSetDropCallback(window, [](GLFWwindow* w, int count, const char** files) {
    auto& self = *static_cast<ViewerWindow*>(glfwGetWindowUserPointer(w));
    if (count > 0) self.openFile(files[0]);
  });
}

/// A scene, or an environment for the one that is shown. What the command line says of a scene is said of the
/// first one.
void ViewerWindow::openFile(const std::filesystem::path& file) {
  if (scene::isEnvironmentFile(file)) {
    SceneQuestion wanted = awaited();
    wanted.environment = file.string();
    open(wanted);
    return;
  }
  SceneQuestion wanted = state_.scene.scene.empty() ? state_.scene : SceneQuestion();
  wanted.scene = file.string();
  postOpening({.scene = carriedOver(state_.scene, wanted, false), .file = openings_ + 1});
}

void ViewerWindow::open(const SceneQuestion& wanted) {
  if (wanted.scene.empty()) {  // before the first scene, which gets it
    state_.scene = wanted;
    if (!wanted.environment.empty()) say(wanted.environment + " lights the scene that is opened first");
    return;
  }
  OpenOrder order{.scene = wanted, .file = opening_ ? opening_->file : shownFile()};
  if (opening_) order.after = opening_->scene;
  postOpening(std::move(order));
}

void ViewerWindow::postOpening(OpenOrder order) {
  opening_ = order;
  ++openings_;
  thread_->open(std::move(order));
  moved();
}

uint64_t ViewerWindow::shownFile() const {
  return facts_ && facts_->scene ? facts_->scene->file : 0;
}

bool ViewerWindow::opensAnotherFile() const {
  return opening_ && opening_->file != shownFile();
}

/// The question as it will be when what was ordered is open. What is to be opened next starts from it, so
/// that no order takes back the one before.
SceneQuestion ViewerWindow::awaited() const {
  return opening_ ? carriedOver(state_.scene, opening_->scene, !opensAnotherFile()) : state_.scene;
}

/// What undo goes back from: the present choice with what is being opened of the same file.
Edit ViewerWindow::present() const {
  Edit edit{state_, orbit_, otherTechniques_, step_};
  if (!opensAnotherFile()) edit.state.scene = awaited();
  return edit;
}

/// What follows from another scene being shown than `before` (null: none). What was changed while the same
/// file was opened again stays, and so does what undo knows.
void ViewerWindow::adopt(const SceneFacts& scene, const SceneFacts* before) {
  const bool sameFile = scene.file == (before != nullptr ? before->file : 0);
  const bool another = before == nullptr || !sameFile;
  state_.scene = carriedOver(state_.scene, scene.options, sameFile);
  if (another) original_ = facts_->scene;
  if (another || !scene.animated) playing_ = false;
  if (!scene.animated) state_.scene.time = 0;  // neither a key nor a slider would set it
  noteRecentScene(scene.options.scene);
  recentScenes_ = recentScenes();
  if (!another) {  // whose file may lie elsewhere when it is read again
    orbit_.recount(before->origin, scene.origin);
    history_.recount(before->origin, scene.origin);
  }
  // A camera that the hand has moved goes on turning around the same point.
  if (sameViewpoint(state_.scene, scene.options) && (another || state_.scene.eye.empty()))
    orbit_ = Orbit(scene.camera, scene.bounds);
  lightEdits_ = session::parseLightEdits(state_.scene.lightSettings);
  chosenName_.clear();
  measured_.clear();
  budgetOf_.clear();  // also where the same file is shown again: with another floor, or read again
  tuneProblem_.clear();
  lightsNew_ = true;
  drag_.reset();
  sceneText_ = scene.options.scene;
  glfwSetWindowTitle(
      context_->window(),
      fmt::format("{} - {}", std::filesystem::path(scene.options.scene).filename().string(), options_.title)
          .c_str());
  moved();
  if (another) history_.restart({state_, orbit_, otherTechniques_, step_});
}

/// What undo or redo brings back; nothing where there is nothing more.
void ViewerWindow::restore(const Edit* edit) {
  if (edit == nullptr) return;
  const SceneQuestion shown = state_.scene, coming = awaited();
  state_ = edit->state;
  copyField(questionField("size"), state_.scene, shown);
  const SceneQuestion wanted = state_.scene;
  copyFields(QuestionEffect::scene, state_.scene, shown);  // until it is open
  orbit_ = edit->orbit;
  otherTechniques_ = edit->others;
  step_ = edit->step;
  lightEdits_ = session::parseLightEdits(state_.scene.lightSettings);
  drag_.reset();
  playing_ = false;
  moved();
  if (!sameFields(QuestionEffect::scene, wanted, coming)) open(wanted);
}

void ViewerWindow::say(std::string message, bool problem) {
  message_ = std::move(message);
  messageIsProblem_ = problem;
  messageAt_ = glfwGetTime();
}

void ViewerWindow::takeFacts() {
  std::shared_ptr<const PictureFacts> newest = thread_->facts();
  if (newest == facts_) return;
  const std::shared_ptr<const SceneFacts> shown = facts_ ? facts_->scene : nullptr;
  facts_ = std::move(newest);
  if (facts_->fatal) std::rethrow_exception(facts_->fatal);
  if (opening_ && facts_->opened == openings_) {
    const auto isShown = [&](const SceneQuestion& question) {
      return facts_->scene && sameFields(QuestionEffect::scene, facts_->scene->options, question);
    };
    if (!isShown(opening_->scene)) {
      history_.forget(opening_->scene);
      if (opening_->after && !isShown(*opening_->after)) history_.forget(*opening_->after);
    }
    opening_.reset();
  }
  if (facts_->scene && facts_->scene != shown) adopt(*facts_->scene, shown.get());
  findChosenLight();
  if (facts_->messages != messagesSeen_) say(facts_->message, facts_->problem);
  messagesSeen_ = facts_->messages;
}

void ViewerWindow::moved() {
  lastChange_ = glfwGetTime();
  unnoted_ = true;
}

bool ViewerWindow::moving() const {
  return playing_ || glfwGetTime() - lastChange_ < kRestAfter;
}

bool ViewerWindow::minimised() const {
  return glfwGetWindowAttrib(context_->window(), GLFW_ICONIFIED) != 0;
}

PictureOrder ViewerWindow::order() const {
  PictureOrder order;
  order.of = facts_->scene;
  order.scene = state_.scene;
  order.techniques = state_.techniques;
  order.others = otherTechniques_;
  order.tone = state_.tone;
  order.automaticExposure = state_.automaticExposure;
  order.size = minimised() ? glm::ivec2(0) : area_;
  order.beside = beside_;
  order.moving = moving();
  order.timed = framePanelOpen_;
  order.inspect = inspection_;
  return order;
}

/// Begins a frame of ImGui in which every key is new that was pressed since the last frame: fields that are
/// typed into see Return, however long the frame took in which it was tapped.
void ViewerWindow::beginFrame() {
  ImGuiIO& io = ImGui::GetIO();
  const auto down = std::to_array(io.KeysDown);
  for (const int key : tapped_)
    if (key != GLFW_KEY_UNKNOWN) io.KeysDown[key] = true;
  tapped_.clear();
  ImGui::NewFrame();
  std::ranges::copy(down, io.KeysDown);
}

void ViewerWindow::postOrder() {
  PictureOrder wanted = order();
  if (posted_ && same(*posted_, wanted)) return;
  posted_ = wanted;
  thread_->show(std::move(wanted));
}

void ViewerWindow::frame() {
  takeFacts();
  budgetNews();
  const double now = glfwGetTime();
  if (playing_) {
    state_.scene.time += now - lastFrame_;
    const double seconds = facts_->scene ? facts_->scene->seconds : 0;
    if (seconds > 0) state_.scene.time = std::fmod(state_.scene.time, seconds);
  }
  lastFrame_ = now;
  if (!messageIsProblem_ && now - messageAt_ > kMessageSeconds) message_.clear();
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  beginFrame();
  panels();
  pictureArea();
  if (inspection_) inspectorWindow();
  openDialog();
  if (unnoted_ && facts_->scene && !moving() && !ImGui::IsAnyItemActive()) {
    history_.note(present());
    unnoted_ = false;
  }
  ImGui::Render();
  postOrder();
  glm::ivec2 size(0);
  glfwGetFramebufferSize(context_->window(), &size.x, &size.y);
  const gl::Functions& gl = context_->gl();
  gl.BindFramebuffer(GL_FRAMEBUFFER, 0);
  gl.Viewport(0, 0, size.x, size.y);
  const GLfloat background[4] = {0.1f, 0.1f, 0.1f, 1};
  gl.ClearBufferfv(GL_COLOR, 0, background);
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  textures_->endFrame();
}

void ViewerWindow::saveScreenshot(const std::filesystem::path& file) const {
  glm::ivec2 size(0);
  glfwGetFramebufferSize(context_->window(), &size.x, &size.y);
  std::vector<uint8_t> pixels(static_cast<size_t>(size.x) * static_cast<size_t>(size.y) * 3);
  const gl::Functions& gl = context_->gl();
  gl.ReadPixels(0, 0, size.x, size.y, GL_RGB, GL_UNSIGNED_BYTE, pixels.data());
  writePng(file, fromBottomFirst(size, pixels));
}

void ViewerWindow::writeStats() const {
  writeTextFile(
      options_.stats,
      fmt::format("{{\"frames\": {}, \"longest_ms\": {:.1f}, \"mean_ms\": {:.2f}, \"pictures\": {}, "
                  "\"resident_mib\": {:.1f}}}\n",
                  frameTimes_.frames, frameTimes_.longestMs,
                  frameTimes_.sumMs / std::max(frameTimes_.frames, 1), facts_ ? facts_->pictures : 0,
                  residentMiB()));
}

/// `shown`: frames of the window since the picture was whole.
bool ViewerWindow::finished(int shown) const {
  return (options_.frames > 0 && shown >= options_.frames) || glfwWindowShouldClose(context_->window()) != 0;
}

void ViewerWindow::run() {
  GLFWwindow* window = context_->window();
  Pace pace;
  int shown = 0;
  for (bool last = false; !last;) {
    const double patience = pace.patience(moving() || drag_ || options_.frames > 0, minimised());
    const double start = glfwGetTime();
    glfwWaitEventsTimeout(patience);
    const double woken = glfwGetTime();
    pace.waited(woken - start);
    frame();
    const bool whole = facts_->settled && posted_ && !posted_->moving;
    if (whole || state_.scene.scene.empty()) ++shown;
    last = finished(shown);
    if (last && !options_.screenshot.empty()) saveScreenshot(options_.screenshot);
    glfwSwapBuffers(window);
    const double ms = 1000 * (glfwGetTime() - woken);
    if (!last) frameTimes_.add(ms);  // the last one may write the screenshot
    context_->throwErrors();
  }
  if (!options_.stats.empty()) writeStats();
}

void runViewer(const ViewerOptions& options) {
  ViewerWindow(options).run();
}

}  // namespace limn::app
