// Declares how a question is turned into a scene with the lights, camera, time and size that it names.
#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "core/base/export.h"
#include "core/question/scene_question.h"
#include "core/reference/reference.h"
#include "core/scene/scene.h"
#include "core/session/warn.h"
#include "core/shading/environment_decomposition.h"

namespace limn::session {

/// Returns the settings by which the question's environment is decomposed into area lights.
LIMN_API shading::DecompositionSettings decompositionSettings(const SceneQuestion& question);

/// Holds the lights of the scene's file, from which relight() starts.
struct FileLights {
  std::vector<scene::Node> nodes;
  std::vector<scene::LightSource> lights;
  std::vector<glm::vec3> emission;  ///< of each material
  float environmentRotation = 0, environmentScale = 1;
  /// Says whether a lamp gets its area by an animation: it is edited as it is at each time.
  bool appearsLater = false;
};

/// Holds the answer to a SceneQuestion: the scene with its lights, its state at a time, and the camera.
struct View {
  scene::Scene scene;
  int animation = scene::kNone;
  double time = 0;
  scene::CameraPose camera;
  scene::CameraPose framing;  ///< the camera of a scene that has none, the same at all times
  scene::Pose pose;
  glm::ivec2 size;
  int aa = 1;  ///< x aa samples in each pixel
  int light = scene::kNone;
  bool unshadowed = false;                               ///< in the reference
  ReliefPaths reliefPaths = ReliefPaths::both;           ///< in the reference
  SubsurfaceModel subsurface = SubsurfaceModel::bssrdf;  ///< in the reference
  FileLights file;
  /// Says whether the scene is lit by default lights. Their lights follow the camera; their environment,
  /// which the scene has unless it has one already, stands still.
  bool defaultLights = false;
};

/// Loads everything that the question names; `warn` receives the scene's warnings. Throws UsageError or
/// Error.
LIMN_API View open(const SceneQuestion& question, const Warn& warn = {});

/// Returns the files that open() reads: the scene's own and those it names, the environment (that of the
/// default lights where they may be wanted) and the grid. Throws Error where the scene or the environment
/// does not exist.
LIMN_API std::vector<std::filesystem::path> inputFiles(const SceneQuestion& question);

/// Gives the scene the lights of the question (--light-size, --default-lights, --set-light and the
/// environment's rotation and scale), starting from those of its file; sets pose and camera at view.time.
/// Writes to materials and to the environment only where something changes. Throws UsageError for lights that
/// do not exist.
LIMN_API void relight(View& view, const SceneQuestion& question);

/// Sets time, pose and camera, and the lights that follow one of them, so that all but the number of the
/// chosen light (chooseLight()) is as open() makes it at that time: default lights follow the camera; lights
/// of which --set-light sets the position or rotation alone, and those that have no area at the start of an
/// animation, the time.
LIMN_API void moveTo(View& view, const SceneQuestion& question, double time);

/// Sets the number of the light that the question chooses (--light) among those of the pose: an animation
/// that makes a lamp none, as one that skews it does, moves the numbers of those behind it. Throws UsageError
/// where there is no such light.
LIMN_API void chooseLight(View& view, const SceneQuestion& question);

/// Says whether moveTo() would call relight(), which may write to materials.
LIMN_API bool movingRelights(const View& view, const SceneQuestion& question, double time);

/// Sets the size of every light that has an extent (--light-size). Throws UsageError when there is none.
LIMN_API void resizeLights(scene::Scene& scene, double size);

/// Returns the question with the defaults in the fields that show() sets in an open scene. Of those that need
/// no other scene the time and --set-light are not among them: what a renderer keeps of geometry that moved
/// (room, hierarchies of triangles) may differ from what it makes of a scene that is opened. Nor are
/// --environment-rotation and --environment-scale, of which renderers keep what they have made.
LIMN_API SceneQuestion openedScene(const SceneQuestion& question);

/// Gives a view that shows one question the camera, size, choice of light and sizes of lights of another of
/// the same openedScene(), so that all is as open() makes it, to the bit. Returns whether lights may have
/// changed: renderers then have to be told (render::Renderer::setTime()). Throws UsageError as open() does;
/// lights may then be set in part.
LIMN_API bool show(View& view, const SceneQuestion& shown, const SceneQuestion& asked);

/// Returns the reference's request for the same picture: the view's scene, size and light. The caller sets
/// samples, and bounces and interfaces where they are not the term's defaults. `view` and `pose` must outlive
/// the request.
LIMN_API reference::Request referenceRequest(const View& view, const scene::Pose& pose,
                                             const scene::CameraPose& camera, Term term);

/// Returns the names of the pose's cameras, as the file has them.
LIMN_API std::vector<std::string> cameraNames(const scene::Pose& pose);

/// Returns the index of a name or "#index" among `names`. Throws UsageError that lists them.
LIMN_API int findNamed(const std::string& what, const std::string& text,
                       const std::vector<std::string>& names);

/// Returns the texts by which findNamed() finds each of the names: "#index" where one before it is the same.
LIMN_API std::vector<std::string> findableNames(std::vector<std::string> names);

/// Returns the camera of the pose that the question names, or `framing` where the pose has none, moved to
/// --eye and --target and given --fov. Throws UsageError for a camera that does not exist.
LIMN_API scene::CameraPose chooseCamera(const SceneQuestion& question, const scene::Pose& pose,
                                        const scene::CameraPose& framing);

}  // namespace limn::session
