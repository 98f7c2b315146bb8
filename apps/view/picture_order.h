// Declares the orders that the window gives to the rendering thread, and the facts that it gets back: plain
// values that no two threads share.
#pragma once

#include <cstdint>
#include <exception>
#include <glm/vec2.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/limn/options.h"
#include "apps/view/reference_worker.h"
#include "core/gpu/objects.h"
#include "core/image/metrics.h"
#include "core/render/renderer.h"
#include "core/session/light_edits.h"

namespace limn::app {

/// Says what the right part of the picture shows.
enum class Beside { nothing, reference, techniques };

/// Declares which texture of the frame is inspected.
struct InspectionOrder {
  render::Inspection texture;
  render::InspectionView view;
  bool automatic = true;  ///< low and high are those of the values, when the picture stands still
  bool operator==(const InspectionOrder&) const = default;
};

struct SceneFacts;

/// Declares the picture that is wanted. Only the latest order counts.
struct PictureOrder {
  std::shared_ptr<const SceneFacts>
      of;               ///< the scene it is a picture of; not of one that was opened meanwhile
  SceneQuestion scene;  ///< what is chosen of that: camera, time, lights
  std::vector<render::TechniqueUse> techniques, others;
  ToneMapping tone;
  bool automaticExposure = false;  ///< the picture determines tone.exposureEv
  glm::ivec2 size{0};              ///< pixels; 0: none is wanted, the window is minimised
  Beside beside = Beside::nothing;
  bool moving = false;  ///< something moves: a smaller picture now is better than a whole one later
  bool timed = false;   ///< passes are timed
  std::optional<InspectionOrder> inspect;
};
bool same(const std::vector<render::TechniqueUse>& a, const std::vector<render::TechniqueUse>& b);
bool same(const PictureOrder& a, const PictureOrder& b);

/// Declares a scene that is to be opened.
struct OpenOrder {
  SceneQuestion scene;
  uint64_t file = 0;    ///< the same number: the same file again, with another floor or read once more
  bool needed = false;  ///< the program ends where it cannot be opened
  /// The order of the same file that was not followed yet when this one was given, which starts from it.
  std::optional<SceneQuestion> after = {};
};

/// Declares a picture that is to be written.
struct SaveOrder {
  PictureOrder picture;
  std::filesystem::path file;        ///< .png or .exr
  std::string command;               ///< that renders it, kept in the file
  std::optional<FrameRange> frames;  ///< a sequence: file.0000.png and so on, at frame / fps seconds
  double fps = 30;
};

/// Holds what is known of the open scene.
struct SceneFacts {
  SceneQuestion options;
  uint64_t file = 0;     ///< of the order that opened it
  glm::dvec3 origin{0};  ///< scene::Scene::origin: what bounds and cameras are counted from
  scene::Bounds bounds;
  std::vector<scene::CameraPose> cameras;  ///< at the time it was opened
  scene::CameraPose camera;                ///< that of the options
  bool environment = false;                ///< it has one: chosen, its own, or that of the default lights
  bool ownEnvironment = false;  ///< that of its file, which lights may stand for as for a chosen one
  bool animated = false;
  double seconds = 0;  ///< of the animation; 0: endless, or longer than times are accepted
};

struct LightFacts {
  std::string name;
  bool editable = false;   ///< belongs to a node of the scene
  session::LightEdit now;  ///< of editable ones
  glsl::Light light{};
};

/// Holds a rendered picture as it is shown.
struct Shot {
  std::shared_ptr<const Image8> image;  ///< null before the first
  glm::ivec2 size{0};
  bool whole = false;   ///< not reduced
  double ms = 0;        ///< of the frame
  std::string problem;  ///< why there is no newer one; empty: there is one
};

struct FrameFacts {
  std::vector<frame::PassReport> passes;
  std::vector<frame::PassTime> times;
  int64_t memoryBytes = 0;
};

struct InspectedFacts {
  std::shared_ptr<const Image8> image;  ///< as large as level 0
  gpu::TextureDesc desc;
  glm::ivec2 size{0};  ///< of the level, the image's lower left corner
  int layers = 1;      ///< of the level
  render::InspectionView view;
  std::shared_ptr<const render::InspectedValues> values;  ///< null while things move
  std::string problem;
};

/// Holds everything that the window is told.
struct PictureFacts {
  std::shared_ptr<const SceneFacts> scene;  ///< null before the first; a new object for each that was opened
  SceneQuestion asked;                      ///< what the picture answers
  scene::CameraPose camera;                 ///< of the picture
  std::vector<LightFacts> lights;
  Shot picture, other;
  std::shared_ptr<const FrameFacts> frame;
  std::optional<InspectedFacts> inspected;
  std::shared_ptr<const Image8> truth, difference;
  float exposureEv = 0;  ///< of the picture
  ReferenceWorker::State reference;
  std::optional<Metrics> metrics;
  std::string whyNoMetrics;  ///< empty where nothing is compared
  std::string shaderProblem;
  int compiled = 0, toCompile = 0;  ///< programs; 0, 0: none is being compiled
  std::string job;                  ///< what is going on besides the picture: "frame 3 of 60"; empty: nothing
  double jobFraction = 0;
  bool saving = false;       ///< the job is a sequence that is being saved, which can be ended
  uint64_t opened = 0;       ///< open orders that have been followed, or have failed
  std::string message;       ///< the last result or problem
  bool problem = false;      ///< the message is one
  uint64_t messages = 0;     ///< messages so far
  uint64_t pictures = 0;     ///< rendered so far
  bool settled = false;      ///< the newest order is shown, and it stands still
  std::exception_ptr fatal;  ///< ends the program
};

}  // namespace limn::app
