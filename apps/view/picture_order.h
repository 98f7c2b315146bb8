// What the window asks of the thread that renders, and what it is told: plain values, shared by nobody.
#pragma once

#include <cstdint>
#include <exception>
#include <glm/vec2.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/limn/light_edits.h"
#include "apps/limn/options.h"
#include "apps/view/reference_worker.h"
#include "core/gpu/objects.h"
#include "core/image/metrics.h"
#include "core/render/renderer.h"

namespace limn::app {

/// What the right part of the picture shows.
enum class Beside { nothing, techniques, reference };

/// A texture of the frame that somebody looks at.
struct InspectionOrder {
  render::Inspection texture;
  render::InspectionView view;
  bool automatic = true;  ///< low and high are those of the values, when the picture stands still
  bool operator==(const InspectionOrder&) const = default;
};

struct SceneFacts;

/// The picture wanted. The latest order is the one that counts.
struct PictureOrder {
  std::shared_ptr<const SceneFacts>
      of;              ///< the scene it is a picture of; not of one that was opened meanwhile
  SceneOptions scene;  ///< what is chosen of that: camera, time, lights
  std::vector<render::TechniqueUse> techniques, others;
  render::Output output = render::Output::final;
  float exposure = 0;  ///< EV
  glm::ivec2 size{0};  ///< pixels; 0: none is wanted, the window is minimised
  Beside beside = Beside::nothing;
  bool moving = false;  ///< something moves: a smaller picture now is better than a whole one later
  bool timed = false;   ///< passes are timed
  std::optional<InspectionOrder> inspect;
};
bool same(const std::vector<render::TechniqueUse>& a, const std::vector<render::TechniqueUse>& b);
bool same(const PictureOrder& a, const PictureOrder& b);

/// A picture to be written.
struct SaveOrder {
  PictureOrder picture;
  std::filesystem::path file;        ///< .png or .exr
  std::string command;               ///< that renders it, kept in the file
  std::optional<FrameRange> frames;  ///< a sequence: file.0000.png and so on, at frame / fps seconds
  double fps = 30;
};

/// What is known of the scene that is open.
struct SceneFacts {
  SceneOptions options;
  glm::dvec3 origin{0};  ///< scene::Scene::origin: what bounds and cameras are counted from
  scene::Bounds bounds;
  std::vector<scene::CameraPose> cameras;  ///< at the time it was opened
  scene::CameraPose camera;                ///< that of the options
  bool animated = false;
  double seconds = 0;  ///< of the animation; 0: endless
};

struct LightFacts {
  std::string name;
  bool editable = false;  ///< belongs to a node of the scene
  LightEdit now;          ///< of editable ones
  glsl::Light light{};
};

/// A rendered picture, ready to be drawn by the window's context: bottom row first.
struct Shot {
  std::shared_ptr<const gpu::Texture> texture;  ///< null before the first
  glm::ivec2 size{0};
  bool whole = false;   ///< not reduced
  double ms = 0;        ///< of the frame
  std::string problem;  ///< why there is none newer; empty: there is
};

struct FrameFacts {
  std::vector<frame::PassReport> passes;
  std::vector<frame::PassTime> times;
  int64_t memoryBytes = 0;
};

struct InspectedFacts {
  std::shared_ptr<const gpu::Texture> texture;  ///< RGBA8
  gpu::TextureDesc desc;
  glm::ivec2 size{0};  ///< of the level, the texture's lower left corner
  int layers = 1;      ///< of the level
  render::InspectionView view;
  std::shared_ptr<const render::InspectedValues> values;  ///< null while things move
  std::string problem;
};

/// All that the window is told.
struct PictureFacts {
  std::shared_ptr<const SceneFacts> scene;  ///< null before the first; a new object for each that was opened
  scene::CameraPose camera;                 ///< of the picture
  std::vector<LightFacts> lights;
  Shot picture, other;
  std::shared_ptr<const FrameFacts> frame;
  std::optional<InspectedFacts> inspected;
  std::shared_ptr<const gpu::Texture> truth, difference;  ///< top row first
  ReferenceWorker::State reference;
  std::optional<Metrics> metrics;
  std::string whyNoMetrics;  ///< empty where nothing is compared
  std::string shaderProblem;
  int compiled = 0, toCompile = 0;  ///< programs; 0, 0: none is being compiled
  std::string job;                  ///< what is going on besides the picture: "frame 3 of 60"; empty: nothing
  double jobFraction = 0;
  std::string message;       ///< what was done or went wrong last
  uint64_t messages = 0;     ///< how many there were
  uint64_t pictures = 0;     ///< rendered so far
  bool settled = false;      ///< the newest order is shown, and it stands still
  std::exception_ptr fatal;  ///< ends the program
};

}  // namespace limn::app
