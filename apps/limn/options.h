// Command-line options that several commands share, each declared once.
#pragma once

#include <CLI/CLI.hpp>
#include <chrono>
#include <filesystem>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/context/context.h"
#include "core/reference/reference.h"
#include "core/render/renderer.h"
#include "core/scene/scene.h"
#include "core/shading/environment_decomposition.h"
#include "core/technique/registry.h"

namespace limn::app {

/// How an environment becomes area lights at infinity.
struct EnvironmentLightOptions {
  double threshold = 0;  ///< 0: not at all
  int resolution = shading::DecompositionSettings{}.resolution;
  std::string shape = "squares";
  bool operator==(const EnvironmentLightOptions&) const = default;

  /// As --lights, --resolution and --shape behind `prefix`.
  void addTo(CLI::App& command, const std::string& prefix);
  shading::DecompositionSettings settings() const;
};

/// What to look at: the scene, the camera, the time.
struct SceneOptions {
  std::filesystem::path scene;
  std::string camera;  ///< name or #index; empty: the file's first camera, or one that frames the scene
  std::string eye, target;
  double fov = 0;  ///< vertical, degrees
  std::filesystem::path environment;
  double environmentRotation = 0;  ///< degrees
  double environmentScale = 1;
  EnvironmentLightOptions environmentLights;
  std::string environmentReflection = "area";  ///< of environmentLights: area or centre
  double time = 0;
  std::string animation;  ///< name or #index; empty: the first
  std::string size = "1280x720";
  std::string light;                       ///< name or #index; empty: all
  double lightSize = 0;                    ///< metres (radians); 0: as the scene has them
  std::vector<std::string> lightSettings;  ///< NAME.PROPERTY=VALUE, see light_edits.h
  std::string sigmaA, sigmaS;          ///< of the medium, per metre: one number or three; empty: the scene's
  std::optional<double> g;             ///< of its phase function
  std::string grid;                    ///< of densities: a file, smoke or none; empty: the scene's
  std::string defaultLights = "auto";  ///< auto: where the scene has neither light nor environment; on; off

  void addTo(CLI::App& command);
  bool operator==(const SceneOptions&) const = default;
};

/// What relight() begins from.
struct FileLights {
  std::vector<scene::Node> nodes;
  std::vector<scene::LightSource> lights;
  std::vector<glm::vec3> emission;  ///< of each material
  float environmentRotation = 0, environmentScale = 1;
};

/// The command line's answer to SceneOptions.
struct View {
  scene::Scene scene;
  int animation = scene::none;
  double time = 0;
  scene::CameraPose camera;
  scene::Pose pose;
  glm::ivec2 size;
  int light = scene::none;
  FileLights file;
  bool defaultLights = false;  ///< the scene is lit by them: they go where the camera goes
};

/// Loads everything SceneOptions names; prints the scene's warnings to stderr unless it is `quiet`. Throws
/// UsageError or Error.
View open(const SceneOptions& options, bool quiet = false);

/// Gives the scene the lights that the options ask for (--light-size, --default-lights, --set-light and the
/// environment's rotation and scale), beginning from those of its file; sets pose and camera at view.time.
/// Writes to materials only where their emission changes.
/// Throws UsageError for lights that are not there.
void relight(View& view, const SceneOptions& options);

/// Sets time, pose and camera, and the default lights, which follow the camera.
void moveTo(View& view, const SceneOptions& options, double time);

/// Gives every light that has an extent another one (--light-size). Throws UsageError where there is none.
void resizeLights(scene::Scene& scene, double size);

/// What the CPU is asked for the same picture: the view's scene, size and light. The caller sets samples, and
/// bounces where they are not the one of indirect light and none of the other terms, and interfaces where
/// they are not the two of specular and none of final. `view` and `pose` must outlive the request.
reference::Request referenceRequest(const View& view, const scene::Pose& pose,
                                    const scene::CameraPose& camera, reference::Term term);

/// The file itself, or the scene of that name that was built with limn. Throws Error when there is neither.
std::filesystem::path findScene(const std::filesystem::path& nameOrFile);

/// The file itself, or the environment map of that name that was built with limn. Throws Error when there is
/// neither.
std::filesystem::path findEnvironment(const std::filesystem::path& nameOrFile);

/// `file` in `folder` of what was built or installed with limn; empty when it is not there.
std::filesystem::path findShared(const std::filesystem::path& folder, const std::filesystem::path& file);

/// With all folders above it. Throws Error.
void createFolder(const std::filesystem::path& folder);

/// Throws Error unless files can be written beside `file`: asked before long work, which would be lost.
void checkWritable(const std::filesystem::path& file);

glm::ivec2 parseSize(const std::string& text);

struct FrameRange {
  int first, last;  // inclusive
};
/// "a:b"; nullopt for an empty text. Throws UsageError.
std::optional<FrameRange> parseFrames(const std::string& text);
/// picture.png, frame 7 -> picture.0007.png
std::filesystem::path numbered(const std::filesystem::path& out, int frame);

/// Index of a name or "#index" among `names`; throws UsageError listing them.
int findNamed(const std::string& what, const std::string& text, const std::vector<std::string>& names);
scene::CameraPose chooseCamera(const SceneOptions& options, const scene::Pose& pose);

/// Which techniques and with what parameters.
struct TechniqueOptions {
  std::string techniques;             ///< comma-separated
  std::vector<std::string> settings;  ///< TECHNIQUE.PARAMETER=VALUE

  void addTo(CLI::App& command);
  std::vector<render::TechniqueUse> resolve(const TechniqueRegistry& registry) const;
};

struct BackendOptions {
  std::string backend = "egl";
  int device = -1;
  bool debug = false;

  void addTo(CLI::App& command);
  ContextOptions contextOptions() const;
};

/// Says on stderr, in one line, what is odd and does not end the run.
void warn(const std::string& message);

/// Runs `work`, reports what it throws (Interrupted, too) in one line on stderr, and gives the exit status.
int guarded(const std::function<int()>& work);

/// Says on stderr that the file is there.
void sayWritten(const std::filesystem::path& file);

/// A bar on a terminal, plain lines (at most one every 10 %, none before `patience` seconds) elsewhere; on
/// stderr.
class Progress {
 public:
  explicit Progress(std::string label, double patience = 0);
  ~Progress();
  void update(double fraction, const std::string& note = {});

 private:
  std::string label_;
  bool terminal_;
  std::chrono::steady_clock::time_point silentUntil_;
  int lastShown_ = -1;
};

}  // namespace limn::app
