// Internal to the viewer: the window, what it shows, and its panels.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/view/orbit.h"
#include "apps/view/reference_worker.h"
#include "apps/view/shown_picture.h"
#include "apps/view/view_state.h"
#include "apps/view/viewer.h"
#include "core/image/metrics.h"

struct GLFWwindow;

namespace limn::app {

inline constexpr float panelWidth = 380;  ///< pixels

/// What the right part of the picture shows.
enum class Beside { nothing, techniques, reference };

class ViewerWindow {
 public:
  explicit ViewerWindow(const ViewerOptions& options);
  ~ViewerWindow();
  ViewerWindow(const ViewerWindow&) = delete;
  ViewerWindow& operator=(const ViewerWindow&) = delete;
  void run();

 private:
  // --- viewer.cpp: the scene, the pictures, the loop
  void openScene(const SceneOptions& wanted);
  void tryOpen(const SceneOptions& wanted);
  void frame();
  void renderPictures();
  void compareAtRest();
  void moved();         ///< something changed what is seen
  bool atRest() const;  ///< the picture is whole and nothing moves
  glm::ivec2 renderSize() const;
  std::vector<render::TechniqueUse> resolve(const TechniqueOptions& options) const;
  void saveScreenshot(const std::filesystem::path& file) const;

  // --- viewer_picture.cpp: the picture and the hands on it
  void pictureArea();
  void handleMouse();
  void handleKeys();
  void press(int key, bool control);
  void nextTechnique();
  void drawPicture(const gpu::Texture& texture, glm::vec2 corner, glm::vec2 size, float from, float to,
                   bool bottomFirst) const;
  void drawColourBar(glm::vec2 corner, float width) const;

  // --- viewer_panels.cpp: the panels
  void panels();
  void scenePanel();
  std::string cameraTitle() const;
  void techniquePanel(std::vector<render::TechniqueUse>& uses);
  void lightPanel();
  void comparePanel();
  void compareWith(Beside what);
  void framePanel();
  void savePanel();
  void save();  ///< the picture, when it is whole
  void saveSuite();
  void copyCommand();
  void guidePanel();
  void chooseStep(size_t step);

  ViewerOptions options_;
  ViewState state_;
  std::unique_ptr<Context> context_;
  std::unique_ptr<gpu::Device> device_;
  TechniqueRegistry registry_;
  std::shared_ptr<View> view_;
  std::unique_ptr<ShownPicture> picture_, other_;
  std::vector<render::TechniqueUse> otherTechniques_;
  Orbit orbit_;
  scene::CameraPose camera_;

  Beside beside_ = Beside::nothing;
  float split_ = 0.5f;           ///< of the picture's width
  bool showDifference_ = false;  ///< instead of the right part
  ReferenceWorker reference_;
  std::optional<Image> truth_;
  gpu::Texture truthTexture_, differenceTexture_;
  std::optional<Metrics> metrics_;
  bool compared_ = false;  ///< metrics_ are of what is shown

  glm::ivec2 area_{0};  ///< pixels of the picture's place in the window
  int reduction_ = 1;   ///< the picture is rendered this much smaller while things move
  double fullMs_ = 0;   ///< of a frame at full size
  double lastChange_ = 0, lastReload_ = 0;
  bool dirty_ = true, playing_ = false, framesPanelOpen_ = false, savePending_ = false;
  double lastFrame_ = 0;
  std::vector<std::pair<int, bool>> pressed_;  ///< GLFW keys since the last frame; true: with control
  size_t step_ = 0;
  std::string message_;  ///< what went wrong last, or was done
  char sceneText_[1024] = "", environmentText_[1024] = "", saveText_[1024] = "";
};

}  // namespace limn::app
