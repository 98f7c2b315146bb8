// Internal to the viewer: declares the window, its content and its panels. All of this runs on the main
// thread and waits for nothing: pictures come from a PictureThread.
#pragma once

#include <algorithm>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/view/budget.h"
#include "apps/view/edit_history.h"
#include "apps/view/folder_listing.h"
#include "apps/view/gizmo.h"
#include "apps/view/orbit.h"
#include "apps/view/picture_thread.h"
#include "apps/view/tune_search.h"
#include "apps/view/view_state.h"
#include "apps/view/viewer.h"
#include "apps/view/window_textures.h"

struct GLFWwindow;
struct ImDrawList;

namespace limn::app {

/// Declares a key that was pressed, and what was held with it.
struct KeyPress {
  int key;  ///< of GLFW; letters as the keyboard's layout has them
  bool control = false, shift = false;
};

class ViewerWindow {
 public:
  explicit ViewerWindow(const ViewerOptions& options);
  ~ViewerWindow();
  ViewerWindow(const ViewerWindow&) = delete;
  ViewerWindow& operator=(const ViewerWindow&) = delete;
  void run();

 private:
  // --- viewer.cpp: the loop
  void listen();
  void frame();
  void beginFrame();
  void takeFacts();
  void adopt(const SceneFacts& scene, const SceneFacts* before);
  Edit present() const;
  void restore(const Edit* edit);
  void say(std::string message, bool problem = false);
  void openFile(const std::filesystem::path& file);
  void open(const SceneQuestion& wanted);  ///< of the same file
  void postOpening(OpenOrder order);
  uint64_t shownFile() const;
  bool opensAnotherFile() const;
  SceneQuestion awaited() const;
  void moved();  ///< something changed what is seen
  bool moving() const;
  bool minimised() const;
  PictureOrder order() const;
  void postOrder();
  bool finished(int shown) const;
  void saveScreenshot(const std::filesystem::path& file) const;
  void writeStats() const;

  // --- viewer_picture.cpp: the picture, mouse and keyboard
  void pictureArea();
  void handleMouse();
  void handleKeys();
  void press(const KeyPress& pressed);
  void drawPictures(glm::vec2 corner, glm::vec2 size);
  bool dragSplit();
  void drawColourBar(glm::vec2 corner, float width) const;
  void statusLine(glm::vec2 corner, float width) const;
  void messageBox(glm::vec2 lowest, float width);

  // --- start_page.cpp
  void startPage();

  // --- open_dialog.cpp
  void browse();
  void browse(const std::filesystem::path& folder);
  void browsedEntries();
  void openDialog();

  // --- light_gizmo.cpp: lights in the picture
  ScreenCamera screen() const;
  void drawLights();
  bool dragLight();  ///< true while the gizmo uses the mouse
  void chooseLight(int light);
  void findChosenLight();
  void editLight(const LightFacts& light, const session::LightEdit& edit);

  // --- panels
  void panels();
  void scenePanel();
  void sceneChooser();
  bool recentScene(const std::filesystem::path& file);
  void ownScene(const std::string& name);
  void cameraChooser();
  void environmentPanel();
  void environmentLightRows(SceneQuestion& wanted);
  void exposureRow();
  void samplesRow();
  void floorRow();
  void timePanel();
  void techniquePanel(std::vector<render::TechniqueUse>& uses);
  void lightPanel();
  void lightEditor(const LightFacts& light);
  void comparePanel();
  void compareWith(Beside what);
  void budgetPanel();
  void readBudgetUnasked();
  void budgetRows();
  void budgetAnswer();
  void budgetSetting(const char* rank, const MeasuredSetting& setting, Term term);
  TuneOrder tuneOrder() const;
  void tunePanel();
  void startTune();
  void budgetNews();
  void readBudget(const SceneQuestion& question);
  void framePanel();
  void passRow(const frame::PassReport& pass, const frame::PassTime* time, double longest);
  void inspectorWindow();
  void inspectorChoices(const frame::PassReport& pass);
  void inspectedPicture(const InspectedFacts& facts);
  void inspect(const frame::PassReport& pass, size_t access);
  void inspectNext();
  void savePanel();
  void save();
  void saveSequence();
  void saveSuite();
  void copyCommand();
  void guidePanel();
  void chooseStep(size_t step);

  ViewerOptions options_;
  ViewState state_;
  std::unique_ptr<Context> context_;
  std::unique_ptr<gpu::Device> device_;  ///< of the window
  std::unique_ptr<WindowTextures> textures_;
  TechniqueRegistry registry_;
  std::unique_ptr<PictureThread> thread_;
  std::shared_ptr<const PictureFacts> facts_;  ///< what is drawn
  std::optional<PictureOrder> posted_;
  uint64_t messagesSeen_ = 0;
  std::optional<OpenOrder> opening_;            ///< the last one, until it has been followed
  uint64_t openings_ = 0;                       ///< that were ordered
  std::shared_ptr<const SceneFacts> original_;  ///< the scene as its file was opened at first

  std::vector<render::TechniqueUse> otherTechniques_;
  Orbit orbit_;
  EditHistory history_;
  bool unnoted_ = false;  ///< something has changed that history_ does not know yet
  std::vector<std::string> ownScenes_;
  std::map<std::string, std::string> aboutScenes_;  ///< what limn's own are for
  std::vector<std::filesystem::path> recentScenes_;
  std::optional<FolderListing> browsing_;  ///< what the dialog shows while it is open
  bool dismissed_ = false;                 ///< Escape was pressed in the dialog
  Beside beside_ = Beside::nothing;
  float split_ = 0.5f;  ///< of the picture's width
  bool splitDragged_ = false;
  bool showDifference_ = false;  ///< instead of the right part
  std::optional<InspectionOrder> inspection_;
  session::LightEdits lightEdits_;
  std::string chosenName_;          ///< of a light; empty: none is chosen
  int chosenLight_ = scene::kNone;  ///< its place among facts_->lights; none where it has vanished
  bool lightsNew_ = true;           ///< of a scene whose changed light, if there is one, is chosen at first
  GizmoMode gizmoMode_ = GizmoMode::move;
  std::optional<GizmoDrag> drag_;
  bool markHeld_ = false;  ///< the mouse has been down since it chose a light by its mark

  float panelWidth_ = 0;  ///< pixels, as all that follows
  glm::vec2 corner_{0};   ///< of the picture's place in the window
  glm::ivec2 area_{0};    ///< its size
  double lastChange_ = 0, lastFrame_ = 0;
  bool playing_ = false, framePanelOpen_ = false, lightPanelOpen_ = false;
  std::vector<KeyPress> pressed_;  ///< since the last frame
  std::vector<int> tapped_;        ///< keys that were pressed since the last frame of ImGui
  size_t step_ = 0;
  std::string message_;  ///< the last problem, or a result of the last seconds
  bool messageIsProblem_ = false;
  double messageAt_ = 0;
  /// Sums the times of the window's frames, without the time in which it waits for events.
  struct FrameTimes {
    int frames = 0;
    double longestMs = 0, sumMs = 0;
    void add(double ms) {
      ++frames;
      sumMs += ms;
      longestMs = std::max(longestMs, ms);
    }
  } frameTimes_;
  std::string sceneText_, saveText_, framesText_ = "0:29", folderText_;  ///< of text fields
  float fps_ = 30;
  std::string budgetText_ = "out/tune", tuneTechniques_;
  std::vector<MeasuredQuestion> measured_;  ///< in that folder
  size_t measuredChosen_ = 0;
  float budgetMs_ = 16;
  int tuneSteps_ = 1;
  const MetricInfo* tuneMetric_ = TuneOrder().metric;
  float tuneMaskedPercent_ = static_cast<float>(100 * TuneOrder().maskedShare);
  TuneOrder tuned_;                   ///< what the search looks for
  std::unique_ptr<TuneSearch> tune_;  ///< the last search
  std::string tuneProblem_;
  SceneQuestion readOf_;      ///< which of the measured questions is to be shown
  bool readUnasked_ = false;  ///< nobody is told what cannot be read
  std::string budgetOf_;      ///< the scene for which the panel was shown
  std::future<std::vector<MeasuredQuestion>> reading_;
  float environmentThreshold_ = 0;  ///< while its slider is held
};

}  // namespace limn::app
