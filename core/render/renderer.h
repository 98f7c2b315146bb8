// Puts a frame together: scene data, G-buffer, the techniques that were asked for, and core's answers to the
// terms that no technique claims (TermInfo::unanswered), all as one frame graph.
//
//     L = T_cam (L_e + sum over lights of L_u V W T_l  (or a technique's `direct`)  + environment + indirect
//     + subsurface + caustic + specular + background) + media
//
// T_l and T_cam are the medium's transmittance from light l to the surface and from there to the camera. The
// pictures of single terms hold T_cam too: they sum to the final one.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/frame/frame_graph.h"
#include "core/image/image.h"
#include "core/image/tone_mapping.h"
#include "core/question/term.h"
#include "core/render/frame_stats.h"
#include "core/render/inspector.h"
#include "core/scene/scene.h"
#include "core/technique/technique.h"

namespace limn::render {

struct TechniqueUse {
  const TechniquePlugin* plugin = nullptr;
  ParameterValues parameters;
  TermSet terms = kAnswerableTerms;  ///< that it is asked for, of those it answers
};

/// Returns the terms that the picture has of the technique: those it answers and is asked for.
LIMN_API TermSet termsOf(const TechniqueUse& use);

/// Returns how people name the use: NAME, or NAME:TERM+TERM where it is not asked for all that it answers.
LIMN_API std::string nameOf(const TechniqueUse& use);
/// Returns the names of all, joined by `separator`.
LIMN_API std::string namesOf(const std::vector<TechniqueUse>& uses, std::string_view separator = ",");

/// Names work that core leaves out of a frame because it would not change the picture.
enum class Saving : uint8_t {
  darkLights,   ///< maps, visibility and shading of lights that emit nothing
  environment,  ///< the light of a black environment
  culling,      ///< instances outside what a view sees
};

struct Settings {
  glm::ivec2 size{1280, 720};
  Term term = Term::final;  ///< what the picture shows
  std::vector<TechniqueUse> techniques;
  /// Index into Pose::lights: the light whose visibility is wanted, or the only one that shines; -1: all.
  int light = -1;
  /// Everything that depends on geometry or lights is computed again in each frame; otherwise unchanged
  /// results are kept.
  bool dynamic = true;
  /// Keep depth, coverage, instance id, albedo and normal for read().
  bool channels = false;
  /// Tone-map the picture for display(), as writePicture() does for PNG files.
  std::optional<ToneMapping> display = {};
  /// A texture to inspect, if the frame has it: see inspector(). A pass that would be left out runs for it.
  std::optional<Inspection> inspect = {};
  /// Work that is done although it could be left out, to measure what leaving it out saves
  /// (core/bench/savings.h).
  std::vector<Saving> forced = {};
  /// Run the bounds of the techniques that have one (core/technique/bound.h), to measure them; the picture is
  /// then theirs.
  bool bound = false;
};

/// Throws UsageError when two techniques claim what the table of terms gives to only one, or when a picture
/// cannot show `term` with these techniques.
LIMN_API void checkTechniques(const std::vector<TechniqueUse>& techniques, Term term);

/// Returns the bounces that a picture of `term` shows, and that its reference should have: those of the
/// technique that answers indirect, its parameter `bounces`, or one; at least 1 of the term indirect, 0 of
/// other pictures without such a technique.
LIMN_API int bouncesOf(Term term, const std::vector<TechniqueUse>& techniques);

/// Returns the most smooth interfaces that a picture of `term` follows, and that its reference should follow:
/// those of the technique which answers specular, its parameter `interfaces`, or into an object and out of
/// it; 0 where none answers or the picture shows no specular surfaces.
LIMN_API int interfacesOf(Term term, const std::vector<TechniqueUse>& techniques);

/// Returns over how many frames a picture of `term` averages: the largest parameter `history` of the
/// techniques that it asks for light or shadows, or 1.
LIMN_API int historyOf(Term term, const std::vector<TechniqueUse>& techniques);

class LIMN_API Renderer {
 public:
  /// Uploads the scene. `scene` and `device` must outlive the renderer.
  Renderer(gpu::Device& device, const scene::Scene& scene, std::filesystem::path shaderOverride = {});
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Chooses what to render. The graph is built at the next render(), whose frame is the first of a sequence:
  /// nothing of frames before it counts. Throws UsageError for techniques that do not go together and for
  /// pictures of 2^27 pixels or more, which cannot be read.
  void configure(Settings settings);
  void setCamera(const scene::CameraPose& camera);
  void setTime(double seconds, int animation = scene::kNone);

  /// Renders one frame. Throws Error (shader errors, memory, sizes). Returns false when it was cancelled
  /// between two passes (frame::FrameGraph::execute); then there is no picture.
  bool render(frame::Timing timing = frame::Timing::off, const frame::FrameGraph::Cancelled& cancelled = {});

  /// Returns how many frames to render for the next picture: in a sequence one, and at its start as many as
  /// the techniques average (historyOf()), so that the first picture is as good as those after it.
  int framesOfPicture() const;

  /// Returns the last frame: R, G, B (visibility: three equal channels), and with Settings::channels Z,
  /// coverage, id (-1: nothing seen), albedo.*, N.*, A (1 where a surface or a background is seen). Waits for
  /// the GPU. Throws Error without one.
  Image read() const;

  /// Returns the last frame, tone-mapped (Settings::display): RGBA8, bottom row first. Throws Error without
  /// one.
  const gpu::Texture& display() const;

  /// Returns the inspector of the last frame; null without Settings::inspect or where the frame does not have
  /// that texture.
  const TextureInspector* inspector() const;
  /// Sets what the following frames show of the inspected texture.
  void setInspectionView(const InspectionView& view);

  /// Sets a callback that render() calls before each program that it compiles.
  void setCompileProgress(frame::FrameGraph::CompileProgress progress);

  /// Waits until the GPU has finished all its work (glFinish).
  void finish();

  /// Returns the state of the scene at the time set.
  const scene::Pose& pose();
  /// Returns the graph of the last frame, until configure() or a frame that has another. Throws Error without
  /// one, as explain() does.
  frame::FrameGraph& graph();
  /// Returns the text of a stage of a program, as another engine could compile it
  /// (gpu::ShaderLibrary::standalone).
  std::string shaderText(const gpu::ProgramDesc& desc, std::string_view file) const;
  /// Returns what the last frame did and what it left out.
  std::vector<frame::PassReport> explain() const;
  /// Returns the part of FrameStats that is known without measuring.
  FrameStats describe() const;
  /// Adds how the shadow maps of the last frame were placed. Waits for the GPU.
  void describeShadowMaps(FrameStats& stats) const;
  /// Returns the size of the live buffers and textures of this device, bytes.
  int64_t memoryBytes() const;

  struct Reload {
    bool changed = false;             ///< a file changed
    int programs = 0;                 ///< compiled again
    std::vector<std::string> errors;  ///< of all files that do not compile in their current state
  };
  /// Compiles the shaders that changed on disk.
  Reload reloadShaders();

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace limn::render
